/* Reading pieces of a line: what all readers of answers need. */
#ifndef FIO_PROTOCOL_WORDS_H
#define FIO_PROTOCOL_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct fio_words {
    const char *at, *end;
} fio_words;

/* Each of these moves on only if it is there. */
bool fio_words_take(fio_words *words, const char *text);
bool fio_words_integer(fio_words *words, int64_t *value); /* digits only, below 10^18 */
bool fio_words_number(fio_words *words, double *value);   /* finite */
void fio_words_blanks(fio_words *words);

static inline bool fio_words_done(const fio_words *words) {
    return words->at == words->end;
}

/* Whether `text` occurs in what is left. */
bool fio_words_contain(const fio_words *words, const char *text);

#endif
