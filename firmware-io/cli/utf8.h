/* Text from outside on its way to a person or a program. */
#ifndef FIO_CLI_UTF8_H
#define FIO_CLI_UTF8_H

#include <stddef.h>

#include "base/text.h"

/* Bytes of the character that begins at `bytes`; 0 if that is no whole UTF-8. */
size_t fio_utf8_character(const char *bytes, size_t size);

/* Append for a terminal: control characters and what is no UTF-8 become '?', so that no printer and
 * no file can send it commands. */
void fio_utf8_visible(fio_text *text, const char *bytes, size_t size);

/* Append for a log: what is not ASCII's visible part or a blank becomes \xNN, \ becomes \\. */
void fio_utf8_escaped(fio_text *text, const char *bytes, size_t size);

/* Append as a JSON string with its quotes; bytes that are no UTF-8 as if they were Latin-1. Cut
 * before FIO_UTF8_JSON_MOST bytes of it. */
enum { FIO_UTF8_JSON_MOST = 1024 };
void fio_utf8_json(fio_text *text, const char *bytes, size_t size);

#endif
