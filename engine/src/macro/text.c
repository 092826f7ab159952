/* A text with macros: what is copied, [keys], and the braces. */
#include <string.h>

#include "macro/run.h"

iso_status macro_put(iso_macro_run *run, const char *text, size_t length) {
    if (run->skip > 0)
        return ISO_OK;
    if (length >= run->size - run->length)
        return iso_fail(ISO_BAD_CONFIG, "%s is longer than %zu bytes with its macros replaced",
                        run->name, run->size - 1);
    if (length > 0)
        memcpy(run->out + run->length, text, length);
    run->length += length;
    return ISO_OK;
}

/* ---- [key], [key_2], [key_[other_key]] ---- */

static iso_status put_value(iso_macro_run *run, iso_datum *value, int64_t index, const char *at) {
    char text[ISO_DATUM_TEXT_SIZE];
    if (value->kind == ISO_DATUM_LIST) {
        if (value->count == 0)
            return macro_fail(run, at, "this list is empty");
        *value = value->item[index >= 0 && index < value->count ? index : 0];
    }
    if (value->kind == ISO_DATUM_TEXT)
        return macro_put(run, value->text, (size_t)value->count);
    return macro_put(run, text, (size_t)iso_datum_write(text, value, true));
}

/* "_12" at the end of the key, cut off; -1 if it ends in no number. */
static int64_t cut_index(char *key) {
    char *line = strrchr(key, '_');
    int64_t index = 0;
    if (!line || line[1] == 0 || strspn(line + 1, "0123456789") != strlen(line + 1))
        return -1;
    for (const char *digit = line + 1; *digit && index < INT32_MAX; digit++)
        index = 10 * index + (*digit - '0');
    *line = 0;
    return index;
}

static iso_status put_key(iso_macro_run *run, char key[MACRO_KEY_SIZE], const char *at) {
    iso_datum value;
    ISO_TRY(macro_find(&value, run, key));
    if (value.kind != ISO_DATUM_NONE)
        return put_value(run, &value, 0, at);
    char whole[MACRO_KEY_SIZE];
    strcpy(whole, key);
    int64_t index = cut_index(key);
    if (index >= 0)
        ISO_TRY(macro_find(&value, run, key));
    if (value.kind == ISO_DATUM_NONE)
        return macro_unknown(run, whole, at);
    return put_value(run, &value, index, at);
}

/* [key[index]]: the inner one is the name of a whole number, or one itself. */
static iso_status put_indexed(iso_macro_run *run, char key[MACRO_KEY_SIZE], const char *at) {
    iso_datum value, index;
    const char *behind = run->token.begin;
    ISO_TRY(macro_scalar(&index, run));
    ISO_TRY(macro_take(run, ']', "a ]"));
    if (run->skip > 0)
        return ISO_OK;
    ISO_TRY(macro_find(&value, run, key));
    size_t length = strlen(key);
    if (value.kind == ISO_DATUM_NONE && length > 1 && key[length - 1] == '_') {
        key[length - 1] = 0; /* [temperature_[current_extruder]] */
        ISO_TRY(macro_find(&value, run, key));
    }
    if (value.kind == ISO_DATUM_NONE)
        return macro_unknown(run, key, at);
    if (index.kind != ISO_DATUM_INTEGER)
        return macro_fail(run, behind, "expected a whole number in [ ]");
    return put_value(run, &value, index.integer, at);
}

static iso_status bracket(iso_macro_run *run) {
    char key[MACRO_KEY_SIZE];
    run->at++;
    ISO_TRY(macro_next(run));
    const iso_token name = run->token;
    if (name.kind != TOKEN_NAME || macro_is_keyword(&name))
        return macro_expected(run, "the name of an option or a variable behind the [");
    if (name.length >= (int32_t)sizeof key)
        return macro_fail(run, name.begin, "the name is longer than %d letters",
                          MACRO_KEY_SIZE - 1);
    memcpy(key, name.begin, (size_t)name.length);
    key[name.length] = 0;
    ISO_TRY(macro_next(run));
    if (macro_is_sign(run, '[')) {
        ISO_TRY(macro_next(run));
        ISO_TRY(put_indexed(run, key, name.begin));
    } else if (macro_is_sign(run, ']') && run->skip == 0) {
        ISO_TRY(put_key(run, key, name.begin));
    }
    return macro_is_sign(run, ']') ? ISO_OK : macro_expected(run, "a ]");
}

/* ---- the whole ---- */

/* Up to the end of the text, or to the elsif, else or endif that ends this branch: then that is the
 * token. */
iso_status macro_text(iso_macro_run *run) {
    ISO_TRY(macro_enter(run));
    for (;;) {
        size_t plain = strcspn(run->at, "{[");
        ISO_TRY(macro_put(run, run->at, plain));
        run->at += plain;
        run->token = (iso_token){.kind = TOKEN_END, .begin = run->at};
        if (*run->at == '[') {
            ISO_TRY(bracket(run));
            continue;
        }
        if (*run->at == 0)
            break;
        run->at++;
        ISO_TRY(macro_next(run));
        if (macro_is_sign(run, '}'))
            return macro_expected(run, "a value or a condition in the braces");
        ISO_TRY(macro_statements(run));
        if (!macro_is_sign(run, '}'))
            break;
    }
    run->depth--;
    return ISO_OK;
}

static bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static iso_status expand(iso_macro_run *run) {
    while (is_space(*run->at)) /* as PrusaSlicer does, only at the beginning */
        run->at++;
    ISO_TRY(macro_text(run));
    if (run->token.kind != TOKEN_END)
        return macro_fail(run, run->token.begin, "this %.*s has no if before it",
                          (int)run->token.length, run->token.begin);
    return ISO_OK;
}

/* Random numbers differ from text to text and from layer to layer, and are the same in every run.
 */
static uint64_t seed_of(const char *name, const iso_macro_scope *scope) {
    uint64_t seed = 0xCBF29CE484222325u;
    for (; *name; name++)
        seed = (seed ^ (unsigned char)*name) * 0x100000001B3u;
    for (int32_t i = 0; i < scope->number_count; i++)
        if (strcmp(scope->number[i].key, "layer_num") == 0)
            seed += (uint64_t)(int64_t)scope->number[i].value * 0x9E3779B97F4A7C15u;
    return seed;
}

static void start(iso_macro_run *run, const char *text, const char *name,
                  const iso_macro_scope *scope) {
    run->scope = scope;
    run->name = name;
    run->text = run->at = text;
    run->token = (iso_token){.kind = TOKEN_END, .begin = text};
    run->out = NULL;
    run->size = run->length = 0;
    run->depth = run->skip = 0;
    run->random = seed_of(name, scope);
    run->local_count = 0;
    run->arena = (iso_arena){0};
    run->spent = 0;
}

iso_status iso_macro_expand(char *out, size_t size, const char *text, const char *name,
                            const iso_macro_scope *scope) {
    iso_macro_run run; /* 20 KiB, most of which most texts never touch */
    start(&run, text, name, scope);
    run.out = out;
    run.size = size;
    iso_status status = expand(&run);
    iso_arena_free(&run.arena);
    if (size > 0)
        out[status == ISO_OK ? run.length : 0] = 0;
    return status;
}

iso_status iso_macro_check(const char *text, const char *name) {
    static const iso_macro_scope none;
    iso_macro_run run;
    start(&run, text, name, &none);
    run.skip = 1;
    iso_status status = expand(&run);
    iso_arena_free(&run.arena);
    return status;
}

iso_status iso_options_expand(char *out, size_t size, const char *text,
                              const iso_options *options) {
    const iso_macro_scope scope = {.options = options};
    return iso_macro_expand(out, size, text, "the G-code", &scope);
}
