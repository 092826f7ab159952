#include "config/json.h"

#include <stdio.h>
#include <string.h>

#include "config/value.h"

/* Length of the valid UTF-8 sequence that starts here (RFC 3629), or 0. */
static int utf8_length(const unsigned char *c) {
    int length = c[0] < 0x80 ? 1 : c[0] < 0xC2 ? 0 : c[0] < 0xE0 ? 2 : c[0] < 0xF0 ? 3 : 4;
    if (c[0] > 0xF4)
        return 0;
    for (int i = 1; i < length; i++)
        if ((c[i] & 0xC0) != 0x80)
            return 0;
    if ((c[0] == 0xE0 && c[1] < 0xA0) || (c[0] == 0xED && c[1] > 0x9F) ||
        (c[0] == 0xF0 && c[1] < 0x90) || (c[0] == 0xF4 && c[1] > 0x8F))
        return 0;
    return length;
}

/* File names may hold any bytes; what isn't UTF-8 becomes U+FFFD. */
static void put_string(iso_output *output, const char *text) {
    iso_output_write(output, "\"", 1);
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        int length = utf8_length(c);
        if (*c == '"' || *c == '\\')
            iso_output_print(output, "\\%c", *c);
        else if (*c == '\n')
            iso_output_print(output, "\\n");
        else if (*c < ' ' || *c == 0x7F)
            iso_output_print(output, "\\u%04x", *c);
        else if (length == 0)
            iso_output_print(output, "\\ufffd");
        else
            iso_output_write(output, c, (size_t)length);
        c += length > 0 ? length : 1;
    }
    iso_output_write(output, "\"", 1);
}

static void put_name(iso_json *json, const char *name) {
    if (json->begun)
        iso_output_print(json->output, ",");
    if (json->depth > 0)
        iso_output_print(json->output, "\n%*s", 2 * json->depth, "");
    json->begun = true;
    if (!name)
        return;
    put_string(json->output, name);
    iso_output_print(json->output, ": ");
}

void iso_json_begin(iso_json *json, const char *name, char bracket) {
    put_name(json, name);
    iso_output_write(json->output, &bracket, 1);
    json->depth++;
    json->begun = false;
}

void iso_json_end(iso_json *json, char bracket) {
    json->depth--;
    if (json->begun)
        iso_output_print(json->output, "\n%*s", 2 * json->depth, "");
    iso_output_write(json->output, &bracket, 1);
    json->begun = true;
    if (json->depth == 0)
        iso_output_print(json->output, "\n");
}

void iso_json_text(iso_json *json, const char *name, const char *text) {
    put_name(json, name);
    put_string(json->output, text);
}

void iso_json_integer(iso_json *json, const char *name, int64_t integer) {
    put_name(json, name);
    iso_output_print(json->output, "%lld", (long long)integer);
}

/* JSON has no infinity and no NaN. */
void iso_json_number(iso_json *json, const char *name, double number) {
    char text[32];
    put_name(json, name);
    if (!(number > -1e15 && number < 1e15)) {
        iso_output_print(json->output, "null");
        return;
    }
    if (number > -9e9 && number < 9e9)
        iso_number_write(text, number);
    else
        snprintf(text, sizeof text, "%lld", (long long)number);
    iso_output_print(json->output, "%s", text);
}
