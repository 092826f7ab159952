/* Text built in a caller's buffer, cut where it is full; numbers without the locale. */
#ifndef FIO_BASE_TEXT_H
#define FIO_BASE_TEXT_H

#include <stddef.h>
#include <stdint.h>

typedef struct fio_text {
    char *bytes; /* always ends with a 0 */
    size_t capacity, length;
} fio_text;

fio_text fio_text_in(char *bytes, size_t capacity);
void fio_text_bytes(fio_text *text, const char *bytes, size_t length);
void fio_text_string(fio_text *text, const char *string);
void fio_text_integer(fio_text *text, int64_t value);

/* `decimals` ≤ 9 digits after the point; magnitudes past 9e8 are written as 9e8's. */
void fio_text_number(fio_text *text, double value, int decimals);

#endif
