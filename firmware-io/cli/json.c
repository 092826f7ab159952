#include "json.h"

#include <string.h>

#include "utf8.h"

static void key_of(fio_json *json, const char *key) {
    fio_text_string(&json->text, ", ");
    fio_utf8_json(&json->text, key, strlen(key));
    fio_text_string(&json->text, ": ");
}

void fio_json_begin(fio_json *json, const char *event) {
    json->text = fio_text_in(json->bytes, sizeof json->bytes);
    fio_text_string(&json->text, "{\"event\": ");
    fio_utf8_json(&json->text, event, strlen(event));
}

void fio_json_bytes(fio_json *json, const char *key, const char *value, size_t size) {
    key_of(json, key);
    fio_utf8_json(&json->text, value, size);
}

void fio_json_string(fio_json *json, const char *key, const char *value) {
    fio_json_bytes(json, key, value, strlen(value));
}

void fio_json_integer(fio_json *json, const char *key, int64_t value) {
    key_of(json, key);
    fio_text_integer(&json->text, value);
}

void fio_json_number(fio_json *json, const char *key, double value, int decimals) {
    key_of(json, key);
    fio_text_number(&json->text, value, decimals);
}

void fio_json_boolean(fio_json *json, const char *key, bool value) {
    key_of(json, key);
    fio_text_string(&json->text, value ? "true" : "false");
}

void fio_json_end(fio_json *json) {
    fio_text_string(&json->text, "}\n");
}
