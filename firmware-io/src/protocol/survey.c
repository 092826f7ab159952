#include "protocol/survey.h"

#include <string.h>

#include "protocol/words.h"

fio_layer_mark fio_layer_mark_of(const char *comment, size_t length) {
    static const char change[] = ";LAYER_CHANGE";
    fio_words words = {comment, comment + length};
    if (fio_words_take(&words, ";LAYER:"))
        return FIO_MARK_NUMBER;
    if (fio_words_take(&words, "; CHANGE_LAYER"))
        return FIO_MARK_BAMBU;
    return fio_words_take(&words, change) ? FIO_MARK_CHANGE : FIO_MARK_NONE;
}

/* "1d 2h 3m 4s", any of them. */
static double read_duration(fio_words words) {
    static const struct {
        const char *unit;
        double seconds;
    } units[] = {{"d", 86400}, {"h", 3600}, {"m", 60}, {"s", 1}};
    double sum = 0, value;
    bool any = false;
    fio_words_blanks(&words);
    while (fio_words_number(&words, &value)) {
        bool known = false;
        for (int i = 0; i < 4 && !known; i++)
            if (fio_words_take(&words, units[i].unit)) {
                sum += value * units[i].seconds;
                known = any = true;
            }
        if (!known)
            return -1;
        fio_words_blanks(&words);
    }
    return any && sum >= 0 ? sum : -1;
}

double fio_comment_seconds(const char *comment, size_t length) {
    static const char *const durations[] = {
        "; estimated printing time (normal mode) =", "; estimated printing time =", NULL};
    fio_words words = {comment, comment + length};
    double value;
    if (fio_words_take(&words, ";TIME:"))
        return fio_words_number(&words, &value) && value >= 0 ? value : -1;
    for (const char *const *start = durations; *start; start++)
        if (fio_words_take(&words, *start))
            return read_duration(words);
    if (!fio_words_take(&words, "; model printing time:"))
        return -1;
    while (!fio_words_done(&words) && !fio_words_take(&words, "total estimated time:"))
        words.at++;
    return read_duration(words);
}

int32_t fio_comment_layers(const char *comment, size_t length) {
    fio_words words = {comment, comment + length};
    int64_t layers;
    if (!fio_words_take(&words, ";LAYER_COUNT:") &&
        !fio_words_take(&words, "; total layer number:") &&
        !fio_words_take(&words, "; total layers count ="))
        return -1;
    fio_words_blanks(&words);
    return fio_words_integer(&words, &layers) && layers < INT32_MAX ? (int32_t)layers : -1;
}

/* Marks that begin early enough in the block to be whole; the rest is looked at with the next one.
 * Most bytes are no ';', and memchr() passes over those many at once. */
static void count_marks(fio_survey *survey, const char *block, size_t size, size_t limit,
                        bool file_start) {
    const char *end = block + size;
    for (const char *p = block; p < block + limit; p++) {
        p = memchr(p, ';', (size_t)(block + limit - p));
        if (!p)
            return;
        bool begins = p == block ? file_start : p[-1] == '\n' || p[-1] == '\r';
        fio_layer_mark mark = begins ? fio_layer_mark_of(p, (size_t)(end - p)) : FIO_MARK_NONE;
        if (survey->mark == FIO_MARK_NONE)
            survey->mark = mark;
        survey->layers += mark != FIO_MARK_NONE && mark == survey->mark;
    }
}

void fio_survey_go_on(fio_survey *survey, const fio_input *input, int64_t bytes, char *block) {
    int64_t goal = survey->at + bytes;
    while (!survey->done && survey->at < goal) {
        size_t kept = (size_t)survey->carried;
        size_t got = fio_input_look(input, survey->at, block + kept, FIO_SURVEY_BLOCK);
        size_t size = kept + got;
        bool first = survey->at == 0;
        survey->at += (int64_t)got;
        survey->done = got == 0 || survey->at >= input->size;
        /* Looked for is every mark that begins before `limit`; that one and its line's end before
         * it stay for the next block. */
        size_t limit = survey->done || size < FIO_SURVEY_CARRY ? size : size - FIO_SURVEY_CARRY / 2;
        count_marks(survey, block, size, limit, first);
        survey->carried = survey->done ? 0 : (int64_t)(size - limit) + (limit > 0);
        memmove(block, block + size - survey->carried, (size_t)survey->carried);
    }
}
