#include "protocol/words.h"

#include <math.h>
#include <string.h>

#include "base/number.h"

bool fio_words_take(fio_words *words, const char *text) {
    size_t length = strlen(text);
    if ((size_t)(words->end - words->at) < length || memcmp(words->at, text, length) != 0)
        return false;
    words->at += length;
    return true;
}

bool fio_words_integer(fio_words *words, int64_t *value) {
    const char *p = words->at;
    int64_t read = 0;
    for (; p < words->end && *p >= '0' && *p <= '9'; p++) {
        if (read >= INT64_C(100000000000000000))
            return false;
        read = read * 10 + (*p - '0');
    }
    if (p == words->at)
        return false;
    words->at = p;
    *value = read;
    return true;
}

bool fio_words_number(fio_words *words, double *value) {
    double read = 0;
    const char *after = fio_number_read(&read, words->at, words->end);
    if (after == words->at || !isfinite(read))
        return false;
    words->at = after;
    *value = read;
    return true;
}

void fio_words_blanks(fio_words *words) {
    while (words->at < words->end && (*words->at == ' ' || *words->at == '\t'))
        words->at++;
}

bool fio_words_contain(const fio_words *words, const char *text) {
    size_t length = strlen(text);
    const char *p = words->at;
    while ((size_t)(words->end - p) >= length) {
        const char *found = memchr(p, text[0], (size_t)(words->end - p) - length + 1);
        if (!found)
            return false;
        if (memcmp(found, text, length) == 0)
            return true;
        p = found + 1;
    }
    return false;
}
