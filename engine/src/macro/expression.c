/* Expressions, by the strength of their operators. */
#include <math.h>
#include <string.h>

#include "macro/run.h"

iso_status macro_enter(iso_macro_run *run) {
    if (run->depth >= MACRO_DEPTH)
        return macro_fail(run, run->token.begin,
                          "brackets and conditions are nested deeper than %d", MACRO_DEPTH);
    run->depth++;
    return ISO_OK;
}

iso_status macro_single(iso_datum *value, iso_macro_run *run, const char *at) {
    if (value->kind != ISO_DATUM_LIST)
        return ISO_OK;
    if (value->count != 1)
        return macro_fail(run, at, "this is a list of %d values; say which one, as [0]",
                          (int)value->count);
    *value = value->item[0];
    return ISO_OK;
}

/* ---- operators ---- */

static iso_status need_number(const iso_macro_run *run, const iso_datum *value, const char *at) {
    return iso_datum_is_numeric(value)
               ? ISO_OK
               : macro_fail(run, at, "expected a number, not %s", iso_datum_kind_name(value->kind));
}

static iso_status whole_result(iso_datum *value, const iso_macro_run *run, int64_t result,
                               const char *at) {
    if (result > INT32_MAX || result < INT32_MIN)
        return macro_fail(run, at, "%lld does not fit into a whole number", (long long)result);
    *value = iso_datum_integer((int32_t)result);
    return ISO_OK;
}

static iso_status compute_whole(iso_datum *value, const iso_macro_run *run, int32_t right,
                                int32_t sign, const char *at) {
    int64_t a = value->integer, b = right;
    switch (sign) {
    case '+':
        return whole_result(value, run, a + b, at);
    case '-':
        return whole_result(value, run, a - b, at);
    case '*':
        return whole_result(value, run, a * b, at);
    case '/':
        return whole_result(value, run, a / b, at);
    default:
        return whole_result(value, run, a % b, at);
    }
}

static iso_status compute(iso_datum *value, iso_macro_run *run, const iso_datum *right,
                          int32_t sign, const char *at) {
    if (sign == '+' && (value->kind == ISO_DATUM_TEXT || right->kind == ISO_DATUM_TEXT))
        return macro_join(value, run, value, right);
    ISO_TRY(need_number(run, value, at));
    ISO_TRY(need_number(run, right, at));
    double a = iso_datum_as_number(value), b = iso_datum_as_number(right), result = a + b;
    if ((sign == '/' || sign == '%') && b == 0)
        return macro_fail(run, at, "division by zero");
    if (value->kind == ISO_DATUM_INTEGER && right->kind == ISO_DATUM_INTEGER)
        return compute_whole(value, run, right->integer, sign, at);
    if (sign == '-')
        result = a - b;
    else if (sign == '*')
        result = a * b;
    else if (sign == '/')
        result = a / b;
    else if (sign == '%')
        result = fmod(a, b);
    if (!(fabs(result) <= 1e300))
        return macro_fail(run, at, "the result is too large");
    *value = iso_datum_number(result);
    return ISO_OK;
}

static int order_of_texts(const iso_datum *a, const iso_datum *b) {
    int32_t both = a->count < b->count ? a->count : b->count;
    int order = both > 0 ? memcmp(a->text, b->text, (size_t)both) : 0;
    return order ? order : (a->count > b->count) - (a->count < b->count);
}

/* Numbers with a point are equal within 1e-8, as PrusaSlicer has it. */
static int order_of_numbers(const iso_datum *a, const iso_datum *b, bool only_equal) {
    double x = iso_datum_as_number(a), y = iso_datum_as_number(b);
    bool inexact = a->kind == ISO_DATUM_NUMBER || b->kind == ISO_DATUM_NUMBER;
    if (only_equal && inexact && fabs(x - y) < 1e-8)
        return 0;
    return (x > y) - (x < y);
}

iso_status macro_compare(bool *truth, iso_macro_run *run, const iso_datum *a, const iso_datum *b,
                         int32_t sign, const char *at) {
    bool only_equal = sign == TWO('=', '=') || sign == TWO('!', '=') || sign == TWO('<', '>');
    int order;
    if (iso_datum_is_numeric(a) && iso_datum_is_numeric(b)) {
        order = order_of_numbers(a, b, only_equal);
    } else if (only_equal && a->kind == ISO_DATUM_BOOL && b->kind == ISO_DATUM_BOOL) {
        order = a->flag - b->flag;
    } else if (a->kind == ISO_DATUM_TEXT || b->kind == ISO_DATUM_TEXT) {
        iso_datum left, right;
        ISO_TRY(macro_text_of(&left, run, a));
        ISO_TRY(macro_text_of(&right, run, b));
        order = order_of_texts(&left, &right);
    } else {
        return macro_fail(run, at, "can't compare %s with %s", iso_datum_kind_name(a->kind),
                          iso_datum_kind_name(b->kind));
    }
    *truth = (sign == '<' && order < 0) || (sign == '>' && order > 0) ||
             (sign == TWO('<', '=') && order <= 0) || (sign == TWO('>', '=') && order >= 0) ||
             (sign == TWO('=', '=') && order == 0) ||
             ((sign == TWO('!', '=') || sign == TWO('<', '>')) && order != 0);
    return ISO_OK;
}

static iso_status apply(iso_datum *value, iso_macro_run *run, const iso_datum *right, int32_t sign,
                        const char *at) {
    if (sign == '+' || sign == '-' || sign == '*' || sign == '/' || sign == '%')
        return compute(value, run, right, sign, at);
    bool truth = false;
    ISO_TRY(macro_compare(&truth, run, value, right, sign, at));
    *value = iso_datum_bool(truth);
    return ISO_OK;
}

/* ---- values ---- */

/* The text between quotes; a \ keeps the character behind it, \n is a line end. */
static iso_status text_literal(iso_datum *value, iso_macro_run *run) {
    const char *from = run->token.begin + 1, *end = from + run->token.length - 2;
    int32_t count = 0;
    void *room;
    ISO_TRY(macro_push(&room, run, (size_t)(end - from)));
    for (char *to = room; from < end; from++) {
        bool escaped = *from == '\\' && from + 1 < end;
        from += escaped;
        to[count++] = (char)(escaped && *from == 'n'   ? '\n'
                             : escaped && *from == 'r' ? '\r'
                                                       : *from);
    }
    *value = iso_datum_text(room, count);
    return ISO_OK;
}

/* [expression] behind a name: beyond its end a list has its first value. */
static iso_status index_value(iso_datum *value, iso_macro_run *run) {
    iso_datum index;
    const char *at = run->token.begin;
    ISO_TRY(macro_next(run));
    ISO_TRY(macro_scalar(&index, run));
    if (!macro_is_sign(run, ']'))
        return macro_expected(run, "a ]");
    ISO_TRY(macro_next(run));
    if (run->skip > 0)
        return ISO_OK;
    if (index.kind != ISO_DATUM_INTEGER)
        return macro_fail(run, at + 1, "expected a whole number in [ ], not %s",
                          index.kind == ISO_DATUM_NUMBER ? "one with a point"
                                                         : iso_datum_kind_name(index.kind));
    if (value->kind != ISO_DATUM_LIST)
        return ISO_OK;
    if (value->count == 0)
        return macro_fail(run, at, "this list is empty");
    bool within = index.integer >= 0 && index.integer < value->count;
    *value = value->item[within ? index.integer : 0];
    return ISO_OK;
}

static iso_status name_value(iso_datum *value, iso_macro_run *run) {
    char key[MACRO_KEY_SIZE];
    const iso_token name = run->token;
    *value = (iso_datum){.kind = ISO_DATUM_NONE};
    if (name.length >= (int32_t)sizeof key)
        return macro_fail(run, name.begin, "the name is longer than %d letters",
                          MACRO_KEY_SIZE - 1);
    memcpy(key, name.begin, (size_t)name.length);
    key[name.length] = 0;
    if (run->skip == 0) {
        ISO_TRY(macro_find(value, run, key));
        if (value->kind == ISO_DATUM_NONE)
            return macro_unknown(run, key, name.begin);
    }
    ISO_TRY(macro_next(run));
    if (macro_is_sign(run, '['))
        ISO_TRY(index_value(value, run));
    return run->skip == 0 ? macro_absolute(value, run, key, name.begin) : ISO_OK;
}

/* (value), or a list (value, value ...) */
static iso_status bracket_value(iso_datum *value, iso_macro_run *run) {
    iso_datum *item = NULL;
    int32_t count = 0;
    ISO_TRY(macro_next(run));
    ISO_TRY(macro_value(value, run));
    while (macro_is_sign(run, ',')) {
        void *grown;
        if (count == 0)
            ISO_TRY(macro_single(value, run, run->token.begin));
        if (count == MACRO_LIST_MAX)
            return macro_expected(run, "no more than 4096 values in a list");
        if ((count & (count - 1)) == 0) { /* room for twice as many */
            ISO_TRY(macro_push(&grown, run, 2 * (size_t)(count + 1) * sizeof *item));
            if (count > 0)
                memcpy(grown, item, (size_t)count * sizeof *item);
            item = grown;
        }
        item[count++] = *value;
        ISO_TRY(macro_next(run));
        ISO_TRY(macro_scalar(value, run));
    }
    if (count > 0) {
        item[count++] = *value;
        *value = iso_datum_list(item, count);
    }
    return macro_take(run, ')', "a )");
}

static iso_status literal(iso_datum *value, iso_macro_run *run) {
    bool truth = macro_is_word(run, "true");
    if (run->token.kind == TOKEN_NUMBER)
        *value = run->token.number;
    else if (run->token.kind == TOKEN_TEXT)
        ISO_TRY(text_literal(value, run));
    else if (truth || macro_is_word(run, "false"))
        *value = iso_datum_bool(truth);
    else
        return macro_expected(run, "a value");
    return macro_next(run);
}

static iso_status primary(iso_datum *value, iso_macro_run *run) {
    if (macro_is_sign(run, '('))
        return bracket_value(value, run);
    int function = macro_function(&run->token);
    if (function >= 0)
        return macro_call(value, run, function);
    if (run->token.kind == TOKEN_NAME && !macro_is_keyword(&run->token))
        return name_value(value, run);
    return literal(value, run);
}

static iso_status negate(iso_datum *value, const iso_macro_run *run, int32_t sign, const char *at) {
    if (run->skip > 0)
        return ISO_OK;
    if (sign == '!') {
        if (value->kind != ISO_DATUM_BOOL)
            return macro_fail(run, at, "expected true or false behind not, not %s",
                              iso_datum_kind_name(value->kind));
        *value = iso_datum_bool(!value->flag);
        return ISO_OK;
    }
    ISO_TRY(need_number(run, value, at));
    if (sign == '-' && value->kind == ISO_DATUM_INTEGER)
        return whole_result(value, run, -(int64_t)value->integer, at);
    if (sign == '-')
        *value = iso_datum_number(-value->number);
    return ISO_OK;
}

static iso_status unary(iso_datum *value, iso_macro_run *run) {
    const char *at = run->token.begin;
    int32_t sign = macro_is_word(run, "not") ? '!' : 0;
    if (macro_is_sign(run, '-') || macro_is_sign(run, '+') || macro_is_sign(run, '!'))
        sign = run->token.sign;
    ISO_TRY(macro_enter(run));
    if (sign) {
        ISO_TRY(macro_next(run));
        ISO_TRY(unary(value, run));
        ISO_TRY(macro_single(value, run, at));
        ISO_TRY(negate(value, run, sign, at));
    } else {
        ISO_TRY(primary(value, run));
    }
    run->depth--;
    return ISO_OK;
}

/* ---- what binds how strongly ---- */

enum { OR = 1, AND, EQUAL, ORDER, SUM, PRODUCT };

static int strength_of(const iso_macro_run *run) {
    if (macro_is_word(run, "or"))
        return OR;
    if (macro_is_word(run, "and"))
        return AND;
    if (run->token.kind != TOKEN_SIGN)
        return 0;
    switch (run->token.sign) {
    case TWO('|', '|'):
        return OR;
    case TWO('&', '&'):
        return AND;
    case TWO('=', '='):
    case TWO('!', '='):
    case TWO('<', '>'):
    case TWO('=', '~'):
    case TWO('!', '~'):
        return EQUAL;
    case '<':
    case '>':
    case TWO('<', '='):
    case TWO('>', '='):
        return ORDER;
    case '+':
    case '-':
        return SUM;
    case '*':
    case '/':
    case '%':
        return PRODUCT;
    default:
        return 0;
    }
}

static iso_status truth_of(bool *truth, const iso_macro_run *run, const iso_datum *value,
                           const char *at) {
    *truth = false;
    if (run->skip > 0)
        return ISO_OK;
    if (value->kind != ISO_DATUM_BOOL)
        return macro_fail(run, at, "expected true or false, not %s",
                          iso_datum_kind_name(value->kind));
    *truth = value->flag;
    return ISO_OK;
}

static iso_status binary(iso_datum *value, iso_macro_run *run, int weakest);

/* The right side counts only if the left one doesn't decide. */
static iso_status logical(iso_datum *value, iso_macro_run *run, int strength, const char *at) {
    bool left, right = false;
    const char *behind = run->token.begin;
    ISO_TRY(truth_of(&left, run, value, at));
    bool decided = run->skip == 0 && left == (strength == OR);
    run->skip += decided;
    iso_datum other;
    ISO_TRY(binary(&other, run, strength + 1));
    ISO_TRY(macro_single(&other, run, behind));
    ISO_TRY(truth_of(&right, run, &other, behind));
    run->skip -= decided;
    *value = iso_datum_bool(decided ? left : right);
    return ISO_OK;
}

static iso_status match(iso_datum *value, iso_macro_run *run, bool inverted, const char *at) {
    ISO_TRY(macro_regex(run));
    if (run->skip > 0)
        return ISO_OK;
    if (value->kind != ISO_DATUM_TEXT)
        return macro_fail(run, at, "expected a text before =~ and !~, not %s",
                          iso_datum_kind_name(value->kind));
    *value = iso_datum_bool(iso_regex_matches(&run->regex, value->text, value->count) != inverted);
    return ISO_OK;
}

static iso_status binary(iso_datum *value, iso_macro_run *run, int weakest) {
    const char *begin = run->token.begin;
    ISO_TRY(unary(value, run));
    int strength;
    while ((strength = strength_of(run)) >= weakest && strength > 0) {
        const char *at = run->token.begin;
        int32_t sign = run->token.sign;
        ISO_TRY(macro_single(value, run, begin));
        if (sign == TWO('=', '~') || sign == TWO('!', '~')) {
            ISO_TRY(match(value, run, sign == TWO('!', '~'), begin));
            continue;
        }
        ISO_TRY(macro_next(run));
        if (strength <= AND) {
            ISO_TRY(logical(value, run, strength, begin));
            continue;
        }
        iso_datum right;
        const char *behind = run->token.begin;
        ISO_TRY(binary(&right, run, strength + 1));
        ISO_TRY(macro_single(&right, run, behind));
        if (run->skip == 0)
            ISO_TRY(apply(value, run, &right, sign, at));
    }
    return ISO_OK;
}

iso_status macro_value(iso_datum *value, iso_macro_run *run) {
    const char *begin = run->token.begin;
    bool truth;
    ISO_TRY(macro_enter(run));
    ISO_TRY(binary(value, run, OR));
    if (macro_is_sign(run, '?')) {
        iso_datum no;
        ISO_TRY(truth_of(&truth, run, value, begin));
        ISO_TRY(macro_next(run));
        run->skip += !truth;
        ISO_TRY(macro_scalar(value, run));
        run->skip -= !truth;
        ISO_TRY(macro_take(run, ':', "a :"));
        run->skip += truth;
        ISO_TRY(macro_scalar(&no, run));
        run->skip -= truth;
        if (!truth)
            *value = no;
    }
    if (run->skip > 0)
        *value = (iso_datum){.kind = ISO_DATUM_NONE};
    run->depth--;
    return ISO_OK;
}

iso_status macro_scalar(iso_datum *value, iso_macro_run *run) {
    const char *begin = run->token.begin;
    ISO_TRY(macro_value(value, run));
    return macro_single(value, run, begin);
}

iso_status macro_condition(bool *truth, iso_macro_run *run) {
    iso_datum value;
    const char *begin = run->token.begin;
    ISO_TRY(macro_scalar(&value, run));
    return truth_of(truth, run, &value, begin);
}
