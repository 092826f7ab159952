/* One JSON object on one line. */
#ifndef FIO_CLI_JSON_H
#define FIO_CLI_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/text.h"

typedef struct fio_json {
    fio_text text;
    char bytes[32768]; /* four of the longest strings, which are cut at FIO_UTF8_JSON_MOST */
} fio_json;

void fio_json_begin(fio_json *json, const char *event);
void fio_json_string(fio_json *json, const char *key, const char *value);
void fio_json_bytes(fio_json *json, const char *key, const char *value, size_t size);
void fio_json_integer(fio_json *json, const char *key, int64_t value);
void fio_json_number(fio_json *json, const char *key, double value, int decimals);
void fio_json_boolean(fio_json *json, const char *key, bool value);
void fio_json_end(fio_json *json); /* with the line's end */

#endif
