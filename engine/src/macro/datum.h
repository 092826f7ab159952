/* Values of the macro language. */
#ifndef ISO_MACRO_DATUM_H
#define ISO_MACRO_DATUM_H

#include <stdbool.h>
#include <stdint.h>

#include <isoslice/geometry.h>
#include <isoslice/status.h>

typedef enum iso_datum_kind {
    ISO_DATUM_NONE, /* of a part that is not evaluated */
    ISO_DATUM_NIL,
    ISO_DATUM_BOOL,
    ISO_DATUM_INTEGER,
    ISO_DATUM_NUMBER,
    ISO_DATUM_TEXT,
    ISO_DATUM_POINT,
    ISO_DATUM_LIST /* of any other kinds */
} iso_datum_kind;

typedef struct iso_datum {
    uint8_t kind;
    bool percent;  /* a number that files write with a % */
    bool relative; /* such a number is of another key's value */
    int32_t count; /* bytes of a text, items of a list */
    union {
        bool flag;
        int32_t integer;
        double number;
        iso_vec2 point;
        const char *text; /* not terminated */
        const struct iso_datum *item;
    };
} iso_datum;

enum { ISO_DATUM_TEXT_SIZE = 64 /* of anything but texts and lists, written */ };

static inline iso_datum iso_datum_bool(bool flag) {
    return (iso_datum){.kind = ISO_DATUM_BOOL, .flag = flag};
}

static inline iso_datum iso_datum_integer(int32_t integer) {
    return (iso_datum){.kind = ISO_DATUM_INTEGER, .integer = integer};
}

static inline iso_datum iso_datum_number(double number) {
    return (iso_datum){.kind = ISO_DATUM_NUMBER, .number = number};
}

static inline iso_datum iso_datum_text(const char *text, int32_t count) {
    return (iso_datum){.kind = ISO_DATUM_TEXT, .count = count, .text = text};
}

static inline iso_datum iso_datum_list(const iso_datum *item, int32_t count) {
    return (iso_datum){.kind = ISO_DATUM_LIST, .count = count, .item = item};
}

static inline bool iso_datum_is_numeric(const iso_datum *datum) {
    return datum->kind == ISO_DATUM_INTEGER || datum->kind == ISO_DATUM_NUMBER;
}

static inline double iso_datum_as_number(const iso_datum *datum) {
    return datum->kind == ISO_DATUM_INTEGER ? datum->integer : datum->number;
}

const char *iso_datum_kind_name(int kind); /* "a text" */

/* Six significant digits without trailing zeros, as C++ streams write; independent of the locale.
 */
int iso_datum_write_number(char text[ISO_DATUM_TEXT_SIZE], double number);

/* Scalars but texts, as {expressions} print them or, if `as_file`, as [keys] do. Returns the
 * length. */
int iso_datum_write(char text[ISO_DATUM_TEXT_SIZE], const iso_datum *datum, bool as_file);

/* An integer or a number at the beginning of text[length]; *used tells how far. False if there is
 * none or an integer is too large. */
bool iso_datum_read_number(iso_datum *number, const char *text, int32_t length, int32_t *used);

#endif
