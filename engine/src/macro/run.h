/* The evaluation of one text: its state, and the parts that share it. */
#ifndef ISO_MACRO_RUN_H
#define ISO_MACRO_RUN_H

#include "base/memory.h"
#include "macro/datum.h"
#include "macro/macro.h"
#include "macro/regex.h"

enum {
    MACRO_DEPTH = 100,           /* of brackets, operators and conditions in each other */
    MACRO_KEY_SIZE = 64,         /* bytes of a name, its end included */
    MACRO_LOCALS = 128,          /* variables of a text; as many globals */
    MACRO_TEXT_MAX = 65535,      /* bytes of a text value */
    MACRO_LIST_MAX = 4096,       /* items of a list */
    MACRO_SCRATCH_MAX = 8 << 20, /* bytes of all values of an evaluation */
    MACRO_SCRATCH_SIZE = 2048    /* of which so many need no allocation */
};

typedef enum iso_token_kind {
    TOKEN_END, /* of the text */
    TOKEN_NUMBER,
    TOKEN_TEXT,
    TOKEN_NAME, /* keywords and functions, too */
    TOKEN_SIGN  /* operators and brackets; `sign` has one or two characters */
} iso_token_kind;

typedef struct iso_token {
    iso_token_kind kind;
    const char *begin;
    int32_t length;
    int32_t sign; /* '+', or TWO('=', '=') */
    iso_datum number;
} iso_token;

#define TWO(a, b) ((a) << 8 | (b))

typedef struct iso_macro_variable {
    char key[MACRO_KEY_SIZE];
    iso_datum value; /* of a global: its parts are in `room` */
    char *room;
    int64_t capacity;
} iso_macro_variable;

typedef struct iso_macro_run {
    const iso_macro_scope *scope;
    const char *name, *text;
    const char *at; /* behind `token` within braces, else the next character */
    iso_token token;
    char *out;
    size_t size, length;
    int32_t depth;
    int32_t skip; /* > 0: only the form is looked at */
    uint64_t random;
    int32_t local_count;
    iso_macro_variable local[MACRO_LOCALS];
    iso_regex regex;
    iso_arena arena;
    size_t spent;
    _Alignas(16) char scratch[MACRO_SCRATCH_SIZE];
} iso_macro_run;

static inline bool macro_token_is(const iso_token *token, const char *word, int32_t length) {
    return token->kind == TOKEN_NAME && token->length == length &&
           memcmp(token->begin, word, (size_t)length) == 0;
}

/* Is the token that word, a literal? */
#define macro_is_word(run, word) macro_token_is(&(run)->token, word, (int32_t)sizeof(word "") - 1)

/* ---- messages and memory ---- */

/* "start_gcode, line 3, column 7: ..." */
iso_status macro_fail(const iso_macro_run *run, const char *at, const char *format, ...)
    ISO_PRINTF(3, 4) ISO_MUST_CHECK;
/* "expected ... but found ..." at the token. */
iso_status macro_expected(const iso_macro_run *run, const char *what) ISO_MUST_CHECK;
iso_status macro_push(void **block, iso_macro_run *run, size_t size) ISO_MUST_CHECK;
/* Two scalars as one text. */
iso_status macro_join(iso_datum *text, iso_macro_run *run, const iso_datum *a,
                      const iso_datum *b) ISO_MUST_CHECK;
/* A scalar as a text value. */
iso_status macro_text_of(iso_datum *text, iso_macro_run *run,
                         const iso_datum *value) ISO_MUST_CHECK;

/* ---- tokens, within braces ---- */

iso_status macro_next(iso_macro_run *run) ISO_MUST_CHECK; /* read the next token */
bool macro_is_sign(const iso_macro_run *run, int32_t sign);
bool macro_is_keyword(const iso_token *token);
iso_status macro_take(iso_macro_run *run, int32_t sign, const char *what) ISO_MUST_CHECK;
/* A /regular expression/ right behind the token; it is compiled and passed over, and the token
 * behind it read. */
iso_status macro_regex(iso_macro_run *run) ISO_MUST_CHECK;

/* ---- names ---- */

/* What a key stands for, a variable or not; kind NONE: nothing. */
iso_status macro_find(iso_datum *value, iso_macro_run *run, const char *key) ISO_MUST_CHECK;
/* A number in percent of another key's becomes what it stands for. */
iso_status macro_absolute(iso_datum *value, iso_macro_run *run, const char *key,
                          const char *at) ISO_MUST_CHECK;
/* The variable of that name, a local before a global; NULL: there is none. */
iso_macro_variable *macro_variable(iso_macro_run *run, const char *key);
iso_status macro_unknown(const iso_macro_run *run, const char *key, const char *at) ISO_MUST_CHECK;
bool macro_is_key(iso_macro_run *run, const char *key); /* is it anything but a variable? */

/* ---- expressions: all begin at the token and end behind it ---- */

iso_status macro_value(iso_datum *value, iso_macro_run *run) ISO_MUST_CHECK; /* lists too */
iso_status macro_scalar(iso_datum *value, iso_macro_run *run) ISO_MUST_CHECK;
iso_status macro_condition(bool *truth, iso_macro_run *run) ISO_MUST_CHECK;
iso_status macro_enter(iso_macro_run *run) ISO_MUST_CHECK; /* one level deeper; run->depth-- */
/* A list has no place here; one of a single value is that value. */
iso_status macro_single(iso_datum *value, iso_macro_run *run, const char *at) ISO_MUST_CHECK;
iso_status macro_compare(bool *truth, iso_macro_run *run, const iso_datum *a, const iso_datum *b,
                         int32_t sign, const char *at) ISO_MUST_CHECK;

/* ---- functions ---- */

/* The function of the name at the token, or -1. */
int macro_function(const iso_token *token);
iso_status macro_call(iso_datum *value, iso_macro_run *run, int function) ISO_MUST_CHECK;

/* ---- statements ---- */

/* What stands in braces up to the closing one, which stays the token. */
iso_status macro_statements(iso_macro_run *run) ISO_MUST_CHECK;
iso_status macro_text(iso_macro_run *run) ISO_MUST_CHECK;
iso_status macro_put(iso_macro_run *run, const char *text, size_t length) ISO_MUST_CHECK;

#endif
