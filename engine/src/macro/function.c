/* The functions of the language. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "macro/run.h"

enum { ARGUMENTS = 8, DIGITS_MAX = 64 };

typedef struct call {
    iso_macro_run *run;
    const char *name;
    int32_t count;
    iso_datum value[ARGUMENTS];
    const char *begin[ARGUMENTS];
} call;

typedef iso_status function_body(iso_datum *result, call *of);

static iso_status fail_argument(const call *of, int i, const char *expected) {
    return macro_fail(of->run, of->begin[i], "%s expects %s, not %s", of->name, expected,
                      iso_datum_kind_name(of->value[i].kind));
}

static iso_status need_numbers(const call *of, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        if (!iso_datum_is_numeric(&of->value[i]))
            return fail_argument(of, i, "a number");
    return ISO_OK;
}

static iso_status to_whole(iso_datum *result, const call *of, double number) {
    if (!(number >= INT32_MIN && number <= INT32_MAX))
        return macro_fail(of->run, of->begin[0], "the number is too large for %s", of->name);
    *result = iso_datum_integer((int32_t)number);
    return ISO_OK;
}

/* ---- numbers ---- */

static iso_status extreme(iso_datum *result, call *of, bool largest) {
    ISO_TRY(need_numbers(of, of->count));
    double best = iso_datum_as_number(&of->value[0]);
    bool whole = of->value[0].kind == ISO_DATUM_INTEGER;
    for (int32_t i = 1; i < of->count; i++) {
        double number = iso_datum_as_number(&of->value[i]);
        best = largest == (number > best) ? number : best;
        whole = whole && of->value[i].kind == ISO_DATUM_INTEGER;
    }
    *result = whole ? iso_datum_integer((int32_t)best) : iso_datum_number(best);
    return ISO_OK;
}

static iso_status call_min(iso_datum *result, call *of) {
    return extreme(result, of, false);
}

static iso_status call_max(iso_datum *result, call *of) {
    return extreme(result, of, true);
}

static iso_status call_abs(iso_datum *result, call *of) {
    ISO_TRY(need_numbers(of, 1));
    if (of->value[0].kind == ISO_DATUM_INTEGER)
        return to_whole(result, of, fabs((double)of->value[0].integer));
    *result = iso_datum_number(fabs(of->value[0].number));
    return ISO_OK;
}

static iso_status call_int(iso_datum *result, call *of) {
    ISO_TRY(need_numbers(of, 1));
    return to_whole(result, of, trunc(iso_datum_as_number(&of->value[0])));
}

static iso_status call_round(iso_datum *result, call *of) {
    ISO_TRY(need_numbers(of, 1));
    double number = iso_datum_as_number(&of->value[0]);
    return to_whole(result, of, number < 0 ? -floor(0.5 - number) : floor(0.5 + number));
}

/* splitmix64 */
static uint64_t next_random(uint64_t *state) {
    uint64_t x = *state += 0x9E3779B97F4A7C15u;
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

static iso_status call_random(iso_datum *result, call *of) {
    ISO_TRY(need_numbers(of, 2));
    double low = iso_datum_as_number(&of->value[0]), high = iso_datum_as_number(&of->value[1]);
    if (low > high)
        return macro_fail(of->run, of->begin[0], "random expects the smaller number first");
    uint64_t number = next_random(&of->run->random);
    if (of->value[0].kind == ISO_DATUM_INTEGER && of->value[1].kind == ISO_DATUM_INTEGER) {
        uint64_t range = (uint64_t)((int64_t)of->value[1].integer - of->value[0].integer) + 1;
        *result = iso_datum_integer((int32_t)(of->value[0].integer + (int64_t)(number % range)));
    } else {
        *result =
            iso_datum_number(low + (high - low) * ((double)(number >> 11) / 9007199254740992.0));
    }
    return ISO_OK;
}

/* ---- digits ---- */

static iso_status bounded(int *number, const call *of, int i) {
    if (of->value[i].kind != ISO_DATUM_INTEGER)
        return fail_argument(of, i, "a whole number");
    int32_t value = of->value[i].integer;
    *number = value < 0 ? 0 : value > DIGITS_MAX ? DIGITS_MAX : (int)value;
    return ISO_OK;
}

/* Right-aligned in `width` columns. printf knows how to round; only its point is the locale's. */
static iso_status write_digits(iso_datum *result, call *of, bool zeros) {
    char text[448];
    int width = 0, decimals = 0;
    ISO_TRY(need_numbers(of, 1));
    ISO_TRY(bounded(&width, of, 1));
    if (of->count > 2)
        ISO_TRY(bounded(&decimals, of, 2));
    double number = iso_datum_as_number(&of->value[0]);
    int count = snprintf(text, sizeof text, zeros ? "%0*.*f" : "%*.*f", width, decimals, number);
    if (count < 0 || count >= (int)sizeof text)
        return macro_fail(of->run, of->begin[0], "the number is too large for %s", of->name);
    for (int i = 0; i < count; i++)
        if (!(text[i] >= '0' && text[i] <= '9') && text[i] != '-' && text[i] != ' ')
            text[i] = '.';
    void *room;
    ISO_TRY(macro_push(&room, of->run, (size_t)count));
    memcpy(room, text, (size_t)count);
    *result = iso_datum_text(room, count);
    return ISO_OK;
}

static iso_status call_digits(iso_datum *result, call *of) {
    return write_digits(result, of, false);
}

static iso_status call_zdigits(iso_datum *result, call *of) {
    return write_digits(result, of, true);
}

/* ---- lists ---- */

static iso_status call_is_nil(iso_datum *result, call *of) {
    ISO_TRY(macro_single(&of->value[0], of->run, of->begin[0]));
    *result = iso_datum_bool(of->value[0].kind == ISO_DATUM_NIL);
    return ISO_OK;
}

static iso_status call_size(iso_datum *result, call *of) {
    bool counted = of->value[0].kind == ISO_DATUM_LIST || of->value[0].kind == ISO_DATUM_TEXT;
    *result = iso_datum_integer(counted ? of->value[0].count : 1);
    return ISO_OK;
}

static iso_status call_empty(iso_datum *result, call *of) {
    bool counted = of->value[0].kind == ISO_DATUM_LIST || of->value[0].kind == ISO_DATUM_TEXT;
    *result = iso_datum_bool(counted && of->value[0].count == 0);
    return ISO_OK;
}

static iso_status call_repeat(iso_datum *result, call *of) {
    void *room;
    if (of->value[0].kind != ISO_DATUM_INTEGER)
        return fail_argument(of, 0, "a whole number");
    int32_t count = of->value[0].integer;
    if (count < 0 || count > MACRO_LIST_MAX)
        return macro_fail(of->run, of->begin[0], "repeat makes lists of 0 to %d values",
                          MACRO_LIST_MAX);
    ISO_TRY(macro_single(&of->value[1], of->run, of->begin[1]));
    ISO_TRY(macro_push(&room, of->run, (size_t)count * sizeof(iso_datum)));
    for (int32_t i = 0; i < count; i++)
        ((iso_datum *)room)[i] = of->value[1];
    *result = iso_datum_list(room, count);
    return ISO_OK;
}

/* ---- those that read their arguments themselves ---- */

/* one_of(value, "text", /expression/, 3 ...) */
static iso_status read_one_of(iso_datum *result, call *of) {
    iso_macro_run *run = of->run;
    iso_datum sought;
    bool found = false, equal = false;
    ISO_TRY(macro_scalar(&sought, run));
    while (macro_is_sign(run, ',')) {
        const char *at = run->at + strspn(run->at, " \t\n");
        if (*at == '/') {
            ISO_TRY(macro_regex(run));
            if (run->skip == 0 && sought.kind != ISO_DATUM_TEXT)
                return macro_fail(run, at, "expected a text to match with, not %s",
                                  iso_datum_kind_name(sought.kind));
            equal = run->skip == 0 && iso_regex_matches(&run->regex, sought.text, sought.count);
        } else {
            iso_datum value;
            ISO_TRY(macro_next(run));
            ISO_TRY(macro_scalar(&value, run));
            if (run->skip == 0)
                ISO_TRY(macro_compare(&equal, run, &sought, &value, TWO('=', '='), at));
        }
        found = found || equal;
    }
    *result = iso_datum_bool(found);
    return ISO_OK;
}

static iso_status table_row(double *x, double *y, iso_macro_run *run) {
    iso_datum row;
    const char *at = run->token.begin;
    ISO_TRY(macro_value(&row, run));
    if (run->skip > 0)
        return ISO_OK;
    if (row.kind != ISO_DATUM_LIST || row.count != 2 || !iso_datum_is_numeric(&row.item[0]) ||
        !iso_datum_is_numeric(&row.item[1]))
        return macro_fail(run, at, "expected a row of the table, as (0, 1.5)");
    *x = iso_datum_as_number(&row.item[0]);
    *y = iso_datum_as_number(&row.item[1]);
    return ISO_OK;
}

/* interpolate_table(x, (x0, y0), (x1, y1) ...): on straight lines between the rows, level beyond
 * the first and the last. */
static iso_status read_table(iso_datum *result, call *of) {
    iso_macro_run *run = of->run;
    iso_datum sought;
    const char *at = run->token.begin;
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0, y = 0, x;
    ISO_TRY(macro_scalar(&sought, run));
    if (run->skip == 0 && !iso_datum_is_numeric(&sought))
        return macro_fail(run, at, "%s expects a number, not %s", of->name,
                          iso_datum_kind_name(sought.kind));
    x = run->skip > 0 ? 0 : iso_datum_as_number(&sought);
    int32_t rows = 0;
    for (; macro_is_sign(run, ','); rows++) {
        ISO_TRY(macro_next(run));
        at = run->token.begin;
        ISO_TRY(table_row(&x1, &y1, run));
        if (run->skip == 0 && rows > 0 && x1 <= x0)
            return macro_fail(run, at, "the rows of a table rise from left to right");
        if (rows == 0 || x >= x1)
            y = y1;
        else if (x > x0)
            y = y0 + (y1 - y0) * ((x - x0) / (x1 - x0));
        x0 = x1;
        y0 = y1;
    }
    if (rows == 0)
        return macro_expected(run, "a , and the rows of the table");
    *result = iso_datum_number(y);
    return ISO_OK;
}

/* ---- calling ---- */

static const struct {
    const char *name;
    int32_t length;
    int least, most; /* arguments; most < 0: it reads them itself */
    bool lists;      /* it takes lists, too */
    function_body *body;
} functions[] = {
#define FUNCTION(name, least, most, lists, body)                                                   \
    { #name, sizeof #name - 1, least, most, lists, body }
    FUNCTION(min, 2, ARGUMENTS, false, call_min),
    FUNCTION(max, 2, ARGUMENTS, false, call_max),
    FUNCTION(abs, 1, 1, false, call_abs),
    FUNCTION(int, 1, 1, false, call_int),
    FUNCTION(round, 1, 1, false, call_round),
    FUNCTION(digits, 2, 3, false, call_digits),
    FUNCTION(zdigits, 2, 3, false, call_zdigits),
    FUNCTION(random, 2, 2, false, call_random),
    FUNCTION(is_nil, 1, 1, true, call_is_nil),
    FUNCTION(size, 1, 1, true, call_size),
    FUNCTION(empty, 1, 1, true, call_empty),
    FUNCTION(repeat, 2, 2, true, call_repeat),
    FUNCTION(one_of, 0, -1, true, read_one_of),
    FUNCTION(interpolate_table, 0, -1, true, read_table),
#undef FUNCTION
};

enum { FUNCTION_COUNT = sizeof functions / sizeof *functions };

int macro_function(const iso_token *token) {
    for (int i = 0; i < FUNCTION_COUNT; i++)
        if (macro_token_is(token, functions[i].name, functions[i].length))
            return i;
    return -1;
}

static iso_status read_arguments(call *of, int function) {
    iso_macro_run *run = of->run;
    int most = functions[function].most;
    for (;;) {
        if (of->count == most)
            return macro_fail(run, run->token.begin, "%s takes no more than %d value%s", of->name,
                              most, most == 1 ? "" : "s");
        of->begin[of->count] = run->token.begin;
        iso_datum *value = &of->value[of->count++];
        ISO_TRY(functions[function].lists ? macro_value(value, run) : macro_scalar(value, run));
        if (!macro_is_sign(run, ','))
            break;
        ISO_TRY(macro_next(run));
    }
    if (of->count < functions[function].least)
        return macro_expected(run, "a , and another value");
    return ISO_OK;
}

iso_status macro_call(iso_datum *value, iso_macro_run *run, int function) {
    call of = {.run = run, .name = functions[function].name};
    *value = (iso_datum){.kind = ISO_DATUM_NONE};
    ISO_TRY(macro_next(run));
    ISO_TRY(macro_take(run, '(', "a ( behind the name of a function"));
    bool reads = functions[function].most < 0;
    ISO_TRY(reads ? functions[function].body(value, &of) : read_arguments(&of, function));
    if (!macro_is_sign(run, ')'))
        return macro_expected(run, "a , or a )");
    if (!reads && run->skip == 0)
        ISO_TRY(functions[function].body(value, &of));
    return macro_next(run);
}
