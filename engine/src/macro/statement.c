/* What stands in braces: conditions, variables, values to print. */
#include <string.h>

#include "macro/run.h"

/* ---- variables ---- */

/* A copy that outlives the texts and lists it came from. */
static iso_status keep(iso_macro_variable *variable, iso_macro_run *run, const iso_datum *value) {
    iso_datum copy = *value;
    const iso_datum *item = value->kind == ISO_DATUM_LIST ? value->item : value;
    int32_t count = value->kind == ISO_DATUM_LIST ? value->count : 1;
    size_t size = (size_t)count * sizeof *item;
    for (int32_t i = 0; i < count; i++)
        size += item[i].kind == ISO_DATUM_TEXT ? (size_t)item[i].count : 0;
    void *fresh; /* first beside the old one: the value may be part of that */
    ISO_TRY(macro_push(&fresh, run, size));
    iso_datum *kept = fresh;
    char *text = (char *)(kept + count);
    for (int32_t i = 0; i < count; i++) {
        kept[i] = item[i];
        if (item[i].kind != ISO_DATUM_TEXT || item[i].count == 0)
            continue;
        memcpy(text, item[i].text, (size_t)item[i].count);
        kept[i].text = text;
        text += item[i].count;
    }
    bool is_global = variable < run->local || variable >= run->local + MACRO_LOCALS;
    if (is_global) {
        ISO_TRY(ISO_GROW(variable->room, variable->capacity, (int64_t)size));
        memcpy(variable->room, fresh, size);
        kept = (iso_datum *)(void *)variable->room;
        for (int32_t i = 0; i < count; i++)
            if (kept[i].kind == ISO_DATUM_TEXT && kept[i].count > 0)
                kept[i].text = variable->room + (kept[i].text - (char *)fresh);
    }
    if (value->kind == ISO_DATUM_LIST)
        copy.item = kept;
    else
        copy = kept[0];
    variable->value = copy;
    return ISO_OK;
}

static iso_status new_variable(iso_macro_variable **variable, iso_macro_run *run, const char *key,
                               bool global, const char *at) {
    iso_macro_globals *globals = run->scope->globals;
    bool outlives = global && globals;
    int32_t count = outlives ? globals->count : run->local_count;
    if (macro_is_key(run, key))
        return macro_fail(run, at, "%s has a value already; give the variable another name", key);
    if (count == MACRO_LOCALS)
        return macro_fail(run, at, "there are more than %d variables", MACRO_LOCALS);
    if (outlives) {
        ISO_TRY(ISO_GROW(globals->variable, globals->capacity, count + 1));
        *variable = &globals->variable[globals->count++];
    } else {
        *variable = &run->local[run->local_count++];
    }
    memset(*variable, 0, sizeof **variable);
    strcpy((*variable)->key, key);
    (*variable)->value.kind = ISO_DATUM_NIL;
    return ISO_OK;
}

void iso_macro_globals_free(iso_macro_globals *globals) {
    for (int32_t i = 0; i < globals->count; i++)
        iso_release(globals->variable[i].room);
    iso_release(globals->variable);
    *globals = (iso_macro_globals){0};
}

static iso_status read_key(char key[MACRO_KEY_SIZE], iso_macro_run *run) {
    if (run->token.kind != TOKEN_NAME || macro_is_keyword(&run->token) ||
        macro_function(&run->token) >= 0)
        return macro_expected(run, "the name of a variable");
    if (run->token.length >= MACRO_KEY_SIZE)
        return macro_fail(run, run->token.begin, "the name is longer than %d letters",
                          MACRO_KEY_SIZE - 1);
    memcpy(key, run->token.begin, (size_t)run->token.length);
    key[run->token.length] = 0;
    return ISO_OK;
}

/* A variable keeps its kind: numbers are cut to whole ones, and anything can be written as text. */
static iso_status convert(iso_datum *value, iso_macro_run *run, const iso_datum *old,
                          const char *at) {
    if (old->kind == value->kind || old->kind == ISO_DATUM_NIL || old->kind == ISO_DATUM_NONE ||
        value->kind == ISO_DATUM_NIL)
        return ISO_OK;
    if (old->kind == ISO_DATUM_TEXT && value->kind != ISO_DATUM_LIST)
        return macro_text_of(value, run, value);
    if (!iso_datum_is_numeric(old) || !iso_datum_is_numeric(value))
        return macro_fail(run, at, "the variable holds %s, so it can't be set to %s",
                          iso_datum_kind_name(old->kind), iso_datum_kind_name(value->kind));
    double number = iso_datum_as_number(value);
    if (old->kind == ISO_DATUM_NUMBER) {
        *value = iso_datum_number(number);
        return ISO_OK;
    }
    if (!(number > -2147483649.0 && number < 2147483648.0))
        return macro_fail(run, at, "the number does not fit into a whole number");
    *value = iso_datum_integer((int32_t)number);
    return ISO_OK;
}

/* local a = 1, b = "x" */
static iso_status declare(iso_macro_run *run) {
    bool global = macro_is_word(run, "global");
    do {
        char key[MACRO_KEY_SIZE];
        iso_datum value;
        ISO_TRY(macro_next(run));
        const char *at = run->token.begin;
        ISO_TRY(read_key(key, run));
        ISO_TRY(macro_next(run));
        ISO_TRY(macro_take(run, '=', "a ="));
        ISO_TRY(macro_value(&value, run));
        if (run->skip > 0)
            continue;
        iso_macro_variable *variable = macro_variable(run, key);
        if (!variable)
            ISO_TRY(new_variable(&variable, run, key, global, at));
        else
            ISO_TRY(convert(&value, run, &variable->value, at));
        ISO_TRY(keep(variable, run, &value));
    } while (macro_is_sign(run, ','));
    return ISO_OK;
}

static iso_status set_item(iso_macro_variable *variable, iso_macro_run *run, const iso_datum *index,
                           iso_datum *value, const char *at) {
    iso_datum list = variable->value;
    void *item;
    if (list.kind != ISO_DATUM_LIST)
        return macro_fail(run, at, "the variable is no list");
    if (index->kind != ISO_DATUM_INTEGER || index->integer < 0 || index->integer >= list.count)
        return macro_fail(run, at, "expected a whole number from 0 to %d in [ ]",
                          (int)list.count - 1);
    ISO_TRY(macro_push(&item, run, (size_t)list.count * sizeof(iso_datum)));
    memcpy(item, list.item, (size_t)list.count * sizeof(iso_datum));
    ISO_TRY(convert(value, run, &list.item[index->integer], at));
    ((iso_datum *)item)[index->integer] = *value;
    list.item = item;
    return keep(variable, run, &list);
}

/* name = value, name[2] = value */
static iso_status assign(iso_macro_run *run) {
    char key[MACRO_KEY_SIZE];
    const char *at = run->token.begin;
    iso_datum index = {.kind = ISO_DATUM_NONE}, value;
    ISO_TRY(read_key(key, run));
    ISO_TRY(macro_next(run));
    bool indexed = macro_is_sign(run, '[');
    if (indexed) {
        ISO_TRY(macro_next(run));
        ISO_TRY(macro_scalar(&index, run));
        ISO_TRY(macro_take(run, ']', "a ]"));
    }
    ISO_TRY(macro_take(run, '=', "a ="));
    ISO_TRY(indexed ? macro_scalar(&value, run) : macro_value(&value, run));
    if (run->skip > 0)
        return ISO_OK;
    iso_macro_variable *variable = macro_variable(run, key);
    if (!variable)
        return macro_fail(run, at,
                          macro_is_key(run, key)
                              ? "%s can't be changed; only variables can"
                              : "there is no variable %s; write local %s = ... first",
                          key, key);
    if (indexed)
        return set_item(variable, run, &index, &value, at);
    ISO_TRY(convert(&value, run, &variable->value, at));
    return keep(variable, run, &value);
}

/* Is it `name =` or `name[...] =`? */
static bool is_assignment(const iso_macro_run *run) {
    const char *at = run->at;
    if (run->token.kind != TOKEN_NAME || macro_is_keyword(&run->token))
        return false;
    at += strspn(at, " \t\r\n");
    if (*at == '[') {
        int depth = 0;
        for (; *at && *at != '}' && *at != ';' && *at != '"'; at++) {
            depth += (*at == '[') - (*at == ']');
            if (depth == 0)
                break;
        }
        at += *at == ']';
        at += strspn(at, " \t\r\n");
    }
    return at[0] == '=' && at[1] != '=' && at[1] != '~';
}

/* ---- conditions ---- */

static bool ends_branch(const iso_macro_run *run) {
    return macro_is_word(run, "elsif") || macro_is_word(run, "else") || macro_is_word(run, "endif");
}

/* Up to elsif, else or endif: text behind a brace, or statements behind then or else. */
static iso_status branch(iso_macro_run *run, bool chosen) {
    run->skip += !chosen;
    if (macro_is_sign(run, '}')) {
        ISO_TRY(macro_text(run));
        if (run->token.kind == TOKEN_END)
            return macro_expected(run, "{elsif}, {else} or {endif}");
    } else {
        if (macro_is_word(run, "then"))
            ISO_TRY(macro_next(run));
        ISO_TRY(macro_statements(run));
    }
    run->skip -= !chosen;
    return ends_branch(run) ? ISO_OK : macro_expected(run, "elsif, else or endif");
}

static iso_status condition(iso_macro_run *run) {
    bool done = false, truth = false;
    ISO_TRY(macro_enter(run));
    do {
        ISO_TRY(macro_next(run));
        run->skip += done;
        ISO_TRY(macro_condition(&truth, run));
        run->skip -= done;
        if (!macro_is_sign(run, '}') && !macro_is_word(run, "then"))
            return macro_expected(run, "a } behind the condition");
        ISO_TRY(branch(run, truth && !done));
        done = done || truth;
    } while (macro_is_word(run, "elsif"));
    if (macro_is_word(run, "else")) {
        ISO_TRY(macro_next(run));
        ISO_TRY(branch(run, !done));
    }
    if (!macro_is_word(run, "endif"))
        return macro_expected(run, "endif");
    run->depth--;
    return macro_next(run);
}

/* ---- statements ---- */

static iso_status print_value(iso_macro_run *run) {
    iso_datum value;
    char text[ISO_DATUM_TEXT_SIZE];
    ISO_TRY(macro_scalar(&value, run));
    if (run->skip > 0)
        return ISO_OK;
    if (value.kind == ISO_DATUM_TEXT)
        return macro_put(run, value.text, (size_t)value.count);
    return macro_put(run, text, (size_t)iso_datum_write(text, &value, false));
}

iso_status macro_statements(iso_macro_run *run) {
    while (!macro_is_sign(run, '}') && !ends_branch(run)) {
        bool is_condition = macro_is_word(run, "if");
        if (macro_is_sign(run, ';')) {
            ISO_TRY(macro_next(run));
            continue;
        }
        if (is_condition)
            ISO_TRY(condition(run));
        else if (macro_is_word(run, "local") || macro_is_word(run, "global"))
            ISO_TRY(declare(run));
        else if (is_assignment(run))
            ISO_TRY(assign(run));
        else
            ISO_TRY(print_value(run));
        if (!is_condition && !macro_is_sign(run, ';') && !macro_is_sign(run, '}') &&
            !ends_branch(run))
            return macro_expected(run, "an operator or a }");
    }
    return ISO_OK;
}
