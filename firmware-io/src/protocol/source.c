#include "protocol/source.h"

#include <string.h>

#include "base/memory.h"
#include "protocol/input.h"
#include "protocol/survey.h"
#include "protocol/words.h"

enum {
    EDGE = 64 * 1024,         /* of a file, hashed and looked into at both ends */
    COMMENT_KEPT = 127,       /* bytes of a comment: more tells nothing */
    AHEAD = 64 * 1024 * 1024, /* looked through for layers at once */
    AHEAD_STEP = 4 * EDGE     /* and with each block that is read */
};

typedef enum fio_source_place { IN_TEXT, IN_COMMENT, IN_PARENTHESES } fio_source_place;

struct fio_source {
    fio_input input;
    fio_source_summary summary;
    fio_survey survey;
    uint64_t fingerprint;
    bool failed, ended;
    /* What the reading has come to. */
    size_t filled, used; /* of `buffer` */
    fio_source_place place;
    bool after_return; /* an LF would belong to the CR before it */
    bool line_started; /* some byte of the line was read */
    bool own_line;     /* the comment is all there is in its line */
    size_t length, comment_length;
    int64_t line, offset, index; /* of what is read now */
    int32_t layer;
    fio_layer_mark mark;
    char text[FIO_COMMAND_MOST + 1], comment[COMMENT_KEPT + 1];
    char buffer[EDGE], block[FIO_SURVEY_CARRY + FIO_SURVEY_BLOCK];
};

/* 0: text, all bytes that need no look. */
enum { ORDINARY, LINE_END, SEMICOLON, PARENTHESIS, CONTROL };

static const unsigned char class_of[256] = {CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            0,
                                            LINE_END,
                                            CONTROL,
                                            CONTROL,
                                            LINE_END,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            CONTROL,
                                            ['('] = PARENTHESIS,
                                            [';'] = SEMICOLON};

static void start_reading(fio_source *source) {
    source->input.at = 0;
    source->failed = source->ended = source->after_return = source->line_started = false;
    source->filled = source->used = source->length = source->comment_length = 0;
    source->place = IN_TEXT;
    source->line = 1;
    source->offset = source->index = 0;
    source->layer = 0;
    source->mark = FIO_MARK_NONE;
}

static fio_source_result fail(fio_source *source, const char *what) {
    source->failed = true;
    (void)!fio_fail(FIO_UNREADABLE, "%s, line %lld: %s", source->input.name,
                    (long long)source->line, what);
    return FIO_SOURCE_FAILED;
}

static fio_source_result fail_binary(fio_source *source, char bad) {
    const char *text = source->text;
    size_t length = source->length;
    if (source->line == 1 && length == 0 && bad == '\x1f')
        return fail(source, "this is compressed (gzip): gunzip it first");
    if (source->line == 1 && length == 2 && memcmp(text, "PK", 2) == 0)
        return fail(source, "this is an archive (ZIP, 3MF): it needs unpacking or slicing first");
    if (source->line == 1 && length >= 4 && memcmp(text, "GCDE", 4) == 0)
        return fail(source, "this is binary G-code (bgcode); have the slicer write plain G-code");
    if (source->line == 1 && length >= 2 &&
        (memcmp(text, "\xff\xfe", 2) == 0 || memcmp(text, "\xfe\xff", 2) == 0))
        return fail(source, "this is UTF-16; G-code is ASCII or UTF-8");
    return fail(source, "a byte that is no text: this is not G-code, or it is damaged");
}

/* Comments of whole lines; those behind commands tell nothing. */
static void take_comment(fio_source *source) {
    const char *comment = source->comment;
    size_t length = source->comment_length;
    source->comment_length = 0;
    if (!source->own_line || length < 6)
        return;
    fio_layer_mark mark = fio_layer_mark_of(comment, length);
    if (source->mark == FIO_MARK_NONE)
        source->mark = mark;
    if (mark != FIO_MARK_NONE && mark == source->mark && source->layer < INT32_MAX)
        source->layer++;
    if (source->summary.seconds < 0)
        source->summary.seconds = fio_comment_seconds(comment, length);
    if (source->summary.layers < 0 && !source->input.seekable)
        source->summary.layers = fio_comment_layers(comment, length);
}

static bool is_shown_text(const fio_words *words) {
    fio_words copy = *words;
    return fio_words_take(&copy, "M117") || fio_words_take(&copy, "M118");
}

/* A number before the command, and the checksum behind it. */
static void strip_frame(fio_words *words) {
    fio_words rest = *words;
    int64_t number;
    bool numbered = false;
    if (rest.at < rest.end && (*rest.at == 'N' || *rest.at == 'n')) {
        rest.at++;
        fio_words_blanks(&rest);
        numbered = fio_words_integer(&rest, &number);
        fio_words_blanks(&rest);
    }
    if (numbered)
        *words = rest;
    const char *star = words->end;
    while (star > words->at && star[-1] >= '0' && star[-1] <= '9')
        star--;
    bool sum = star > words->at && star < words->end && star[-1] == '*';
    if (sum && (numbered || !is_shown_text(words)))
        words->end = star - 1;
}

static void trim(fio_words *words) {
    fio_words_blanks(words);
    while (words->end > words->at && (words->end[-1] == ' ' || words->end[-1] == '\t'))
        words->end--;
}

static void note_time_left(fio_source *source, fio_words words) {
    double minutes;
    if (!fio_words_take(&words, "M73 "))
        return;
    while (!fio_words_done(&words) && *words.at != 'R')
        words.at++;
    if (fio_words_take(&words, "R") && fio_words_number(&words, &minutes) && minutes >= 0)
        source->summary.seconds = minutes * 60;
}

/* The line is whole: true if there is a command in it. */
static bool take_line(fio_source *source, fio_source_command *command) {
    fio_words words = {source->text, source->text + source->length};
    if (source->comment_length > 0)
        take_comment(source);
    if (source->line == 1)
        (void)fio_words_take(&words, "\xef\xbb\xbf");
    trim(&words);
    strip_frame(&words);
    trim(&words);
    source->length = 0;
    source->place = IN_TEXT;
    source->line_started = false;
    int64_t line = source->line++;
    size_t length = (size_t)(words.end - words.at);
    if (length == 0 || (length == 1 && *words.at == '%'))
        return false;
    if (source->summary.seconds < 0)
        note_time_left(source, words);
    source->text[words.end - source->text] = 0;
    *command = (fio_source_command){.text = words.at,
                                    .length = length,
                                    .index = source->index++,
                                    .line = line,
                                    .offset = source->offset,
                                    .layer = source->layer};
    return true;
}

/* Take ordinary bytes of a command; false if there are too many. */
static bool take_text(fio_source *source) {
    const char *p = source->buffer + source->used, *end = source->buffer + source->filled;
    char *to = source->text + source->length, *limit = source->text + FIO_COMMAND_MOST;
    while (source->length == 0 && p < end && (*p == ' ' || *p == '\t'))
        p++;
    while (p < end && to < limit && class_of[(unsigned char)*p] == ORDINARY)
        *to++ = *p++;
    size_t taken = (size_t)(p - source->buffer) - source->used;
    source->line_started = source->line_started || taken > 0;
    source->used += taken;
    source->offset += (int64_t)taken;
    source->length = (size_t)(to - source->text);
    return p == end || to < limit || class_of[(unsigned char)*p] != ORDINARY;
}

static void skip_comment(fio_source *source) {
    const char *p = source->buffer + source->used, *end = source->buffer + source->filled;
    const char *start = p;
    while (p < end && *p != '\n' && *p != '\r' && (source->place == IN_COMMENT || *p != ')'))
        p++;
    size_t taken = (size_t)(p - start), room = COMMENT_KEPT - source->comment_length;
    if (source->place == IN_COMMENT) {
        size_t kept = taken < room ? taken : room;
        memcpy(source->comment + source->comment_length, start, kept);
        source->comment_length += kept;
    }
    source->used += taken;
    source->offset += (int64_t)taken;
}

static void step(fio_source *source) {
    source->used++;
    source->offset++;
}

typedef enum fio_source_step { STEP_ON, STEP_LINE, STEP_FAILED } fio_source_step;

/* The bytes up to the next that means something, and that one. */
static fio_source_step read_on(fio_source *source) {
    if (source->place == IN_TEXT) {
        if (!take_text(source)) {
            (void)!fail(source, "the command is longer than 4095 bytes");
            return STEP_FAILED;
        }
    } else {
        skip_comment(source);
    }
    if (source->used == source->filled)
        return STEP_ON;
    char c = source->buffer[source->used];
    int class = class_of[(unsigned char)c];
    if (class == LINE_END) {
        step(source);
        source->after_return = c == '\r';
        return c == '\r' ? STEP_ON : STEP_LINE;
    }
    if (source->place == IN_PARENTHESES) { /* ')' */
        source->place = IN_TEXT;
    } else if (class == CONTROL) {
        (void)!fail_binary(source, c);
        return STEP_FAILED;
    } else if (class == SEMICOLON) {
        source->place = IN_COMMENT;
        source->own_line = !source->line_started;
        source->line_started = true;
        return STEP_ON; /* the comment begins with it */
    } else if (class == PARENTHESIS) {
        source->place = IN_PARENTHESES;
    }
    source->line_started = true;
    step(source);
    return STEP_ON;
}

static int64_t refill(fio_source *source) {
    int64_t got = fio_input_read(&source->input, source->buffer, sizeof source->buffer);
    if (got > 0) {
        source->filled = (size_t)got;
        source->used = 0;
    }
    if (got > 0 && source->input.seekable && !source->survey.done) {
        fio_survey_go_on(&source->survey, &source->input, AHEAD_STEP, source->block);
        if (source->survey.done && source->survey.layers > 0)
            source->summary.layers = source->survey.layers;
    }
    return got;
}

fio_source_result fio_source_next(fio_source *source, fio_source_command *command) {
    if (source->failed)
        return FIO_SOURCE_FAILED;
    while (!source->ended) {
        if (source->used == source->filled) {
            int64_t got = refill(source);
            if (got == FIO_INPUT_LATER)
                return FIO_SOURCE_LATER;
            source->failed = got == FIO_INPUT_FAILED;
            if (source->failed)
                return FIO_SOURCE_FAILED;
            source->ended = got == 0;
            if (source->ended)
                break;
        }
        fio_source_step came = STEP_LINE;
        if (source->after_return) { /* the line waits for the LF that may belong to it */
            source->after_return = false;
            if (source->buffer[source->used] == '\n')
                step(source);
        } else {
            came = read_on(source);
        }
        if (came == STEP_FAILED)
            return FIO_SOURCE_FAILED;
        if (came == STEP_LINE && take_line(source, command))
            return FIO_SOURCE_COMMAND;
    }
    return take_line(source, command) ? FIO_SOURCE_COMMAND : FIO_SOURCE_END;
}

static uint64_t hash(uint64_t sum, const char *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) /* FNV-1a */
        sum = (sum ^ (unsigned char)bytes[i]) * UINT64_C(1099511628211);
    return sum;
}

/* Comments of one edge of the file. */
static void look_at_edge(fio_source *source, const char *bytes, size_t size) {
    const char *end = bytes + size;
    while (bytes < end && source->summary.seconds < 0) {
        const char *after = memchr(bytes, '\n', (size_t)(end - bytes));
        size_t length = (size_t)((after ? after : end) - bytes);
        if (length > 0 && *bytes == ';')
            source->summary.seconds = fio_comment_seconds(bytes, length);
        bytes += length + 1;
    }
}

static void look_at_edges(fio_source *source) {
    fio_input *input = &source->input;
    uint64_t sum = UINT64_C(14695981039346656037) ^ (uint64_t)input->size;
    size_t head = fio_input_look(input, 0, source->buffer, EDGE);
    sum = hash(sum, source->buffer, head);
    look_at_edge(source, source->buffer, head);
    int64_t from = input->size > EDGE ? input->size - EDGE : 0;
    size_t tail = fio_input_look(input, from, source->buffer, EDGE);
    sum = hash(sum, source->buffer, tail);
    look_at_edge(source, source->buffer, tail);
    source->fingerprint = sum ? sum : 1;
}

static fio_source *make(fio_status *status) {
    fio_source *source = fio_allocate(sizeof *source);
    *status =
        source ? FIO_OK
               : fio_fail(FIO_NO_MEMORY, "no memory to read a job (%zu bytes)", sizeof(fio_source));
    return source;
}

static void begin(fio_source *source) {
    source->summary = (fio_source_summary){.bytes = -1, .layers = -1, .seconds = -1};
    if (source->input.seekable) {
        source->summary.bytes = source->input.size;
        look_at_edges(source);
        fio_survey_go_on(&source->survey, &source->input, AHEAD, source->block);
        if (source->survey.done && source->survey.layers > 0)
            source->summary.layers = source->survey.layers;
    }
    start_reading(source);
}

fio_status fio_source_open(fio_source **source, const char *path) {
    fio_status status;
    *source = NULL;
    fio_source *made = make(&status);
    if (!made)
        return status;
    status = fio_input_open(&made->input, path);
    if (status != FIO_OK) {
        fio_release(made);
        return status;
    }
    begin(made);
    *source = made;
    return FIO_OK;
}

fio_status fio_source_memory(fio_source **source, const char *bytes, size_t size) {
    fio_status status;
    *source = NULL;
    fio_source *made = make(&status);
    if (!made)
        return status;
    fio_input_memory(&made->input, bytes, size);
    begin(made);
    *source = made;
    return FIO_OK;
}

void fio_source_close(fio_source *source) {
    if (source)
        fio_input_close(&source->input);
    fio_release(source);
}

fio_status fio_source_seek(fio_source *source, int64_t index) {
    fio_source_command command;
    if (!source->input.seekable)
        return fio_fail(FIO_USAGE, "%s is no file: it can't be read from elsewhere",
                        source->input.name);
    if (index < 0)
        return fio_fail(FIO_USAGE, "there is no command %lld", (long long)index);
    if (index < source->index || source->failed || source->ended)
        start_reading(source);
    while (source->index < index) {
        fio_source_result result = fio_source_next(source, &command);
        if (result == FIO_SOURCE_FAILED)
            return FIO_UNREADABLE;
        if (result != FIO_SOURCE_COMMAND)
            return fio_fail(FIO_USAGE, "%s has no command %lld, but only %lld", source->input.name,
                            (long long)index, (long long)source->index);
    }
    return FIO_OK;
}

int fio_source_descriptor(const fio_source *source) {
    return source->input.seekable ? -1 : source->input.descriptor;
}

const fio_source_summary *fio_source_whole(const fio_source *source) {
    return &source->summary;
}

uint64_t fio_source_fingerprint(const fio_source *source) {
    return source->fingerprint;
}
