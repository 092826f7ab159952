#include "config/value.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { PLACES = 9 };
static const int64_t NANO = 1000000000;
static const int64_t NUMBER_LIMIT = 1000000; /* so that value * 10^9 < 2^53 */

typedef struct word {
    iso_option_kind kind;
    int32_t value;
    const char *text;
} word;

static const word all_words[] = {
#define ISO_WORD(kind, value, text) {ISO_VALUE_##kind, value, text},
#include "config/options.inl"
#undef ISO_WORD
};

enum { WORD_COUNT = sizeof all_words / sizeof *all_words };

const char *iso_value_word(iso_option_kind kind, int32_t i) {
    for (int w = 0; w < WORD_COUNT; w++)
        if (all_words[w].kind == kind && i-- == 0)
            return all_words[w].text;
    return NULL;
}

size_t iso_value_size(iso_option_kind kind) {
    switch (kind) {
    case ISO_VALUE_BOOL:
        return sizeof(bool);
    case ISO_VALUE_INTEGER:
        return sizeof(int32_t);
    case ISO_VALUE_NUMBER:
    case ISO_VALUE_PERCENT:
        return sizeof(double);
    case ISO_VALUE_RELATIVE:
        return sizeof(iso_relative);
    case ISO_VALUE_TEXT:
        return ISO_TEXT_SIZE;
    case ISO_VALUE_PLACE:
        return sizeof(iso_place);
    case ISO_VALUE_POINTS:
        return sizeof(iso_points);
    case ISO_VALUE_NUMBERS:
        return sizeof(iso_numbers);
    default: /* a word */
        return sizeof(int32_t);
    }
}

static const char *skip_spaces(const char *text) {
    while (*text == ' ' || *text == '\t')
        text++;
    return text;
}

/* ---- numbers ---- */

/* The digits of a decimal number and where its point stands: digits * 10^exponent. */
typedef struct decimal {
    int64_t digits;
    int exponent, digit_count;
} decimal;

static const char *read_digits(decimal *number, const char *text, int step) {
    for (; isdigit((unsigned char)*text); text++) {
        number->digit_count++;
        if (number->digits < INT64_MAX / 100) {
            number->digits = number->digits * 10 + (*text - '0');
            number->exponent -= step;
        } else {
            number->exponent += 1 - step;
        }
    }
    return text;
}

static const char *read_exponent(decimal *number, const char *text) {
    if (*text != 'e' && *text != 'E')
        return text;
    const char *at = text + 1;
    int sign = *at == '-' ? -1 : 1;
    if (*at == '-' || *at == '+')
        at++;
    if (!isdigit((unsigned char)*at))
        return text;
    int exponent = 0;
    for (; isdigit((unsigned char)*at); at++)
        if (exponent < 10000)
            exponent = exponent * 10 + (*at - '0');
    number->exponent += sign * exponent;
    return at;
}

/* digits * 10^exponent in units of 10^-9, to nearest; false if beyond the limit */
static bool to_nano(int64_t *nano, const decimal *number) {
    int64_t n = number->digits;
    int shift = number->exponent + PLACES;
    if (n == 0) {
        *nano = 0;
        return true;
    }
    for (; shift > 0; shift--) {
        if (n > NUMBER_LIMIT * NANO / 10)
            return false;
        n *= 10;
    }
    if (shift < -19)
        n = 0;
    for (; shift < -1 && n > 0; shift++)
        n /= 10;
    if (shift < 0)
        n = (n + 5) / 10;
    *nano = n;
    return n <= NUMBER_LIMIT * NANO;
}

bool iso_number_read(double *number, const char **text) {
    const char *at = *text;
    bool negative = *at == '-';
    if (*at == '-' || *at == '+')
        at++;
    decimal read = {0};
    at = read_digits(&read, at, 0);
    if (*at == '.')
        at = read_digits(&read, at + 1, 1);
    if (read.digit_count == 0)
        return false;
    at = read_exponent(&read, at);
    int64_t nano;
    if (!to_nano(&nano, &read))
        return false;
    *number = (double)(negative ? -nano : nano) / (double)NANO;
    *text = at;
    return true;
}

int iso_number_write(char text[32], double number) {
    double scaled = number * (double)NANO;
    int64_t nano = (int64_t)(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
    uint64_t size = nano < 0 ? 0 - (uint64_t)nano : (uint64_t)nano;
    unsigned long long whole = size / (uint64_t)NANO, part = size % (uint64_t)NANO;
    int length = snprintf(text, 32, "%s%llu.%09llu", nano < 0 ? "-" : "", whole, part);
    while (text[length - 1] == '0')
        length--;
    if (text[length - 1] == '.')
        length--;
    text[length] = 0;
    return length;
}

/* ---- reading ---- */

static const char *parse_bool(bool *flag, const char *text) {
    static const char *const spelling[] = {"0", "1", "false", "true", "no", "yes", "off", "on"};
    for (size_t i = 0; i < sizeof spelling / sizeof *spelling; i++) {
        if (strcmp(text, spelling[i]) == 0) {
            *flag = i % 2 == 1;
            return NULL;
        }
    }
    return "is neither 0 nor 1";
}

static const char *check_range(double number, const iso_option_info *info) {
    return number < info->min || number > info->max ? "is out of range" : NULL;
}

static const char *parse_number(double *number, const iso_option_info *info, const char *text) {
    if (!iso_number_read(number, &text) || *skip_spaces(text) != 0)
        return "is not a number";
    return check_range(*number, info);
}

static const char *parse_integer(int32_t *integer, const iso_option_info *info, const char *text) {
    double number;
    if (!iso_number_read(&number, &text) || *skip_spaces(text) != 0)
        return "is not a number";
    *integer = (int32_t)number;
    return *integer != number ? "is not a whole number" : check_range(number, info);
}

static const char *parse_percent(double *number, const iso_option_info *info, const char *text) {
    if (!iso_number_read(number, &text))
        return "is not a number";
    text = skip_spaces(text);
    if (*text == '%')
        text++;
    return *skip_spaces(text) != 0 ? "is not a number" : check_range(*number, info);
}

/* A share of something has no range of its own but 0 to 1000 %; a zero share is allowed where zero
 * is. */
static const char *parse_relative(iso_relative *relative, const iso_option_info *info,
                                  const char *text) {
    if (!iso_number_read(&relative->value, &text))
        return "is not a number";
    text = skip_spaces(text);
    relative->percent = *text == '%';
    if (relative->percent)
        text++;
    if (*skip_spaces(text) != 0)
        return "is not a number";
    if (!relative->percent)
        return check_range(relative->value, info);
    bool fits =
        relative->value <= 1000 && (info->min > 0 ? relative->value >= 1 : relative->value >= 0);
    return fits ? NULL : "is out of range";
}

static const char *parse_word(int32_t *value, iso_option_kind kind, const char *text) {
    for (int w = 0; w < WORD_COUNT; w++) {
        if (all_words[w].kind == kind && strcmp(text, all_words[w].text) == 0) {
            *value = all_words[w].value;
            return NULL;
        }
    }
    return "is not known";
}

/* Spaces at both ends are dropped: a line of an ini file can't carry them. */
static const char *parse_text(char *out, const char *text) {
    size_t n = 0;
    for (; *text; text++) {
        char c = *text;
        if (c == '\\' && text[1] != 0) {
            c = *++text;
            c = c == 'n' ? '\n' : c == 'r' ? '\r' : c == 't' ? '\t' : c;
        }
        if (c == '\r' || (c == ' ' && n == 0))
            continue;
        if ((unsigned char)c < ' ' && c != '\n' && c != '\t')
            return "has a control character";
        if (n + 1 == ISO_TEXT_SIZE)
            return "is longer than 16383 bytes";
        out[n++] = c;
    }
    while (n > 0 && out[n - 1] == ' ')
        n--;
    out[n] = 0;
    return NULL;
}

/* "1x2" or "1,2" */
static const char *read_pair(double *x, double *y, const char **text, char separator) {
    const char *at = skip_spaces(*text);
    if (!iso_number_read(x, &at))
        return "is not a point";
    at = skip_spaces(at);
    if (*at != 'x' && *at != separator)
        return "is not a point";
    at = skip_spaces(at + 1);
    if (!iso_number_read(y, &at))
        return "is not a point";
    *text = skip_spaces(at);
    return NULL;
}

static const char *parse_place(iso_place *place, const iso_option_info *info, const char *text) {
    *place = (iso_place){0};
    if (*skip_spaces(text) == 0)
        return NULL;
    const char *wrong = read_pair(&place->x, &place->y, &text, ',');
    if (!wrong && *text != 0)
        wrong = "is not a point";
    if (!wrong)
        wrong = check_range(place->x, info);
    if (!wrong)
        wrong = check_range(place->y, info);
    place->given = true;
    return wrong;
}

static const char *parse_points(iso_points *points, const iso_option_info *info, const char *text) {
    points->count = 0;
    do {
        if (points->count == ISO_POINTS_MAX)
            return "has more than 256 points";
        iso_vec2 *point = &points->point[points->count++];
        const char *wrong = read_pair(&point->x, &point->y, &text, 'x');
        if (!wrong)
            wrong = check_range(point->x, info);
        if (!wrong)
            wrong = check_range(point->y, info);
        if (wrong)
            return wrong;
    } while (*text++ == ',');
    if (text[-1] != 0)
        return "is not a list of points as 0x0,200x0,200x200";
    return points->count < 3 ? "has fewer than three points" : NULL;
}

static const char *parse_numbers(iso_numbers *numbers, const iso_option_info *info,
                                 const char *text) {
    numbers->count = 0;
    text = skip_spaces(text);
    if (*text == 0)
        return NULL;
    do {
        text = skip_spaces(text);
        if (numbers->count == ISO_NUMBERS_MAX)
            return "has more than 4096 numbers";
        double *number = &numbers->value[numbers->count++];
        if (!iso_number_read(number, &text))
            return "is not a list of numbers";
        if (check_range(*number, info))
            return check_range(*number, info);
        text = skip_spaces(text);
    } while (*text++ == ',');
    return text[-1] != 0 ? "is not a list of numbers" : NULL;
}

const char *iso_value_parse(iso_value *value, const iso_option_info *info, const char *text) {
    switch (info->kind) {
    case ISO_VALUE_BOOL:
        return parse_bool(&value->flag, text);
    case ISO_VALUE_INTEGER:
        return parse_integer(&value->integer, info, text);
    case ISO_VALUE_NUMBER:
        return parse_number(&value->number, info, text);
    case ISO_VALUE_PERCENT:
        return parse_percent(&value->number, info, text);
    case ISO_VALUE_RELATIVE:
        return parse_relative(&value->relative, info, text);
    case ISO_VALUE_TEXT:
        return parse_text(value->text, text);
    case ISO_VALUE_PLACE:
        return parse_place(&value->place, info, text);
    case ISO_VALUE_POINTS:
        return parse_points(&value->points, info, text);
    case ISO_VALUE_NUMBERS:
        return parse_numbers(&value->numbers, info, text);
    default:
        return parse_word(&value->integer, info->kind, text);
    }
}

/* ---- writing ---- */

/* Text that grows to the right and is cut off at its end, while its length counts on. */
typedef struct writer {
    char *text;
    size_t size, length;
} writer;

static void put_char(writer *out, char c) {
    if (out->length + 1 < out->size)
        out->text[out->length] = c;
    out->length++;
}

static void put_text(writer *out, const char *text) {
    for (; *text; text++)
        put_char(out, *text);
}

static void put_number(writer *out, double number) {
    char text[32];
    iso_number_write(text, number);
    put_text(out, text);
}

static void put_escaped(writer *out, const char *text) {
    for (; *text; text++) {
        if (*text == '\n' || *text == '\t' || *text == '\\')
            put_char(out, '\\');
        put_char(out, *text == '\n' ? 'n' : *text == '\t' ? 't' : *text);
    }
}

static void put_pair(writer *out, double x, char separator, double y) {
    put_number(out, x);
    put_char(out, separator);
    put_number(out, y);
}

static void put_word(writer *out, iso_option_kind kind, int32_t value) {
    for (int w = 0; w < WORD_COUNT; w++)
        if (all_words[w].kind == kind && all_words[w].value == value)
            put_text(out, all_words[w].text);
}

static void put_relative(writer *out, const iso_relative *relative) {
    put_number(out, relative->value);
    if (relative->percent)
        put_char(out, '%');
}

static void put_points(writer *out, const iso_points *points) {
    for (int32_t i = 0; i < points->count; i++) {
        if (i > 0)
            put_char(out, ',');
        put_pair(out, points->point[i].x, 'x', points->point[i].y);
    }
}

static void put_numbers(writer *out, const iso_numbers *numbers) {
    for (int32_t i = 0; i < numbers->count; i++) {
        if (i > 0)
            put_char(out, ',');
        put_number(out, numbers->value[i]);
    }
}

static void put_value(writer *out, const void *value, iso_option_kind kind) {
    const iso_place *place = value;
    switch (kind) {
    case ISO_VALUE_BOOL:
        put_char(out, *(const bool *)value ? '1' : '0');
        break;
    case ISO_VALUE_INTEGER:
        put_number(out, *(const int32_t *)value);
        break;
    case ISO_VALUE_NUMBER:
        put_number(out, *(const double *)value);
        break;
    case ISO_VALUE_PERCENT:
        put_number(out, *(const double *)value);
        put_char(out, '%');
        break;
    case ISO_VALUE_RELATIVE:
        put_relative(out, value);
        break;
    case ISO_VALUE_TEXT:
        put_escaped(out, value);
        break;
    case ISO_VALUE_PLACE:
        if (place->given)
            put_pair(out, place->x, ',', place->y);
        break;
    case ISO_VALUE_POINTS:
        put_points(out, value);
        break;
    case ISO_VALUE_NUMBERS:
        put_numbers(out, value);
        break;
    default:
        put_word(out, kind, *(const int32_t *)value);
    }
}

size_t iso_value_format(char *text, size_t size, const void *value, iso_option_kind kind) {
    writer out = {text, size, 0};
    put_value(&out, value, kind);
    if (size > 0)
        text[out.length < size ? out.length : size - 1] = 0;
    return out.length;
}
