/* What the parts of an evaluation share: messages, scratch, the tokens. */
#include "macro/run.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- messages ---- */

iso_status macro_fail(const iso_macro_run *run, const char *at, const char *format, ...) {
    char message[384];
    int line = 1, column = 1;
    for (const char *c = run->text; c < at; c++) {
        bool continues = ((unsigned char)*c & 0xC0) == 0x80; /* columns count letters of UTF-8 */
        column = *c == '\n' ? 1 : column + !continues;
        line += *c == '\n';
    }
    va_list values;
    va_start(values, format);
    vsnprintf(message, sizeof message, format, values);
    va_end(values);
    return iso_fail(ISO_BAD_CONFIG, "%s, line %d, column %d: %s", run->name, line, column, message);
}

iso_status macro_expected(const iso_macro_run *run, const char *what) {
    const iso_token *token = &run->token;
    if (token->kind == TOKEN_END)
        return macro_fail(run, token->begin, "expected %s before the end of the text", what);
    int length = token->length > 40 ? 40 : (int)token->length;
    return macro_fail(run, token->begin, "expected %s, not %.*s", what, length, token->begin);
}

/* ---- scratch ---- */

iso_status macro_push(void **block, iso_macro_run *run, size_t size) {
    size_t rounded = (size + 15) & ~(size_t)15;
    *block = NULL;
    if (rounded > MACRO_SCRATCH_MAX - run->spent)
        return macro_fail(run, run->token.begin, "the values take more than %d MiB",
                          MACRO_SCRATCH_MAX >> 20);
    *block = run->spent + rounded <= sizeof run->scratch ? run->scratch + run->spent
                                                         : iso_arena_push(&run->arena, rounded);
    run->spent += rounded;
    return *block ? ISO_OK : iso_no_memory(rounded);
}

static iso_datum written(const iso_datum *value, char buffer[ISO_DATUM_TEXT_SIZE]) {
    if (value->kind == ISO_DATUM_TEXT)
        return *value;
    return iso_datum_text(buffer, iso_datum_write(buffer, value, false));
}

iso_status macro_join(iso_datum *text, iso_macro_run *run, const iso_datum *a, const iso_datum *b) {
    char of_a[ISO_DATUM_TEXT_SIZE], of_b[ISO_DATUM_TEXT_SIZE];
    iso_datum left = written(a, of_a), right = written(b, of_b);
    int32_t count = left.count + right.count;
    void *room;
    if (count > MACRO_TEXT_MAX)
        return macro_fail(run, run->token.begin, "the text has more than %d bytes", MACRO_TEXT_MAX);
    ISO_TRY(macro_push(&room, run, (size_t)count));
    if (left.count > 0)
        memcpy(room, left.text, (size_t)left.count);
    if (right.count > 0)
        memcpy((char *)room + left.count, right.text, (size_t)right.count);
    *text = iso_datum_text(room, count);
    return ISO_OK;
}

iso_status macro_text_of(iso_datum *text, iso_macro_run *run, const iso_datum *value) {
    iso_datum nothing = iso_datum_text("", 0);
    if (value->kind == ISO_DATUM_TEXT) {
        *text = *value;
        return ISO_OK;
    }
    return macro_join(text, run, value, &nothing);
}

/* ---- tokens ---- */

static bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

static bool begins_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static int32_t name_length(const char *at) {
    int32_t length = 0;
    while (begins_name(at[length]) || is_digit(at[length]))
        length++;
    return length;
}

static iso_status read_number(iso_macro_run *run) {
    iso_token *token = &run->token;
    const char *begin = token->begin;
    int32_t length = (int32_t)strspn(begin, "0123456789.eE+-");
    token->kind = TOKEN_NUMBER;
    if (!iso_datum_read_number(&token->number, begin, length, &token->length))
        return macro_fail(run, begin, "%.*s is no number that fits", length > 40 ? 40 : (int)length,
                          begin);
    return ISO_OK;
}

/* "text", up to the quote that no \ precedes. */
static iso_status read_text(iso_macro_run *run) {
    const char *at = run->token.begin + 1;
    while (*at && *at != '"')
        at += *at == '\\' && at[1] ? 2 : 1;
    run->token.kind = TOKEN_TEXT;
    run->token.length = (int32_t)(at + 1 - run->token.begin);
    return *at ? ISO_OK
               : macro_fail(run, run->token.begin, "expected a \" at the end of this text");
}

static void read_sign(iso_macro_run *run) {
    static const char *const twos[] = {"==", "!=", "<>", "<=", ">=", "=~", "!~", "&&", "||"};
    const char *begin = run->token.begin;
    run->token.kind = TOKEN_SIGN;
    run->token.length = 1;
    run->token.sign = (unsigned char)*begin;
    for (size_t i = 0; i < sizeof twos / sizeof *twos; i++)
        if (begin[0] == twos[i][0] && begin[1] == twos[i][1]) {
            run->token.length = 2;
            run->token.sign = TWO(begin[0], begin[1]);
        }
}

iso_status macro_next(iso_macro_run *run) {
    while (is_space(*run->at))
        run->at++;
    iso_token *token = &run->token;
    *token = (iso_token){.kind = TOKEN_END, .begin = run->at};
    char c = *run->at;
    if (begins_name(c)) {
        token->kind = TOKEN_NAME;
        token->length = name_length(run->at);
    } else if (is_digit(c) || (c == '.' && is_digit(run->at[1]))) {
        ISO_TRY(read_number(run));
    } else if (c == '"') {
        ISO_TRY(read_text(run));
    } else if (c) {
        read_sign(run);
    }
    run->at = token->begin + token->length;
    return ISO_OK;
}

bool macro_is_sign(const iso_macro_run *run, int32_t sign) {
    return run->token.kind == TOKEN_SIGN && run->token.sign == sign;
}

bool macro_is_keyword(const iso_token *token) {
    static const struct {
        const char *word;
        int32_t length;
    } words[] = {{"if", 2}, {"then", 4}, {"elsif", 5}, {"else", 4},  {"endif", 5}, {"and", 3},
                 {"or", 2}, {"not", 3},  {"true", 4},  {"false", 5}, {"local", 5}, {"global", 6}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (macro_token_is(token, words[i].word, words[i].length))
            return true;
    return false;
}

iso_status macro_take(iso_macro_run *run, int32_t sign, const char *what) {
    return macro_is_sign(run, sign) ? macro_next(run) : macro_expected(run, what);
}

iso_status macro_regex(iso_macro_run *run) {
    while (is_space(*run->at))
        run->at++;
    run->token = (iso_token){.kind = TOKEN_SIGN, .begin = run->at, .length = *run->at != 0};
    if (*run->at == 0)
        run->token.kind = TOKEN_END;
    if (*run->at != '/')
        return macro_expected(run, "a /regular expression/");
    const char *begin = run->at + 1, *end = begin;
    while (*end && *end != '/')
        end += *end == '\\' && end[1] ? 2 : 1;
    if (!*end)
        return macro_fail(run, run->at, "expected a / at the end of this regular expression");
    int32_t at;
    const char *wrong = iso_regex_compile(&run->regex, begin, (int32_t)(end - begin), &at);
    if (wrong)
        return macro_fail(run, begin + at, "%s", wrong);
    run->at = end + 1;
    return macro_next(run);
}
