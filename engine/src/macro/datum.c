#include "macro/datum.h"

#include <stdio.h>
#include <string.h>

const char *iso_datum_kind_name(int kind) {
    switch (kind) {
    case ISO_DATUM_NIL:
        return "nil";
    case ISO_DATUM_BOOL:
        return "true or false";
    case ISO_DATUM_INTEGER:
    case ISO_DATUM_NUMBER:
        return "a number";
    case ISO_DATUM_TEXT:
        return "a text";
    case ISO_DATUM_POINT:
        return "a point";
    case ISO_DATUM_LIST:
        return "a list";
    default:
        return "nothing";
    }
}

enum { SIGNIFICANT = 6 };

/* The digits of a number rounded to six of them: 0.d1d2d3... * 10^exponent. */
static int round_digits(char digit[SIGNIFICANT], int *exponent, double magnitude) {
    char text[32];
    int count = 0, power = 0;
    snprintf(text, sizeof text, "%.*e", SIGNIFICANT - 1, magnitude);
    const char *at = text;
    for (; *at && *at != 'e'; at++) /* whatever the locale writes for the point is passed over */
        if (*at >= '0' && *at <= '9' && count < SIGNIFICANT)
            digit[count++] = *at;
    bool negative = at[0] && at[1] == '-';
    for (at += *at ? 2 : 0; *at >= '0' && *at <= '9'; at++)
        power = 10 * power + (*at - '0');
    *exponent = (negative ? -power : power) + 1;
    while (count > 1 && digit[count - 1] == '0')
        count--;
    return count;
}

int iso_datum_write_number(char text[ISO_DATUM_TEXT_SIZE], double number) {
    char digit[SIGNIFICANT];
    char *to = text;
    if (number < 0 || (number == 0 && 1 / number < 0))
        *to++ = '-';
    if (number == 0) {
        *to++ = '0';
        *to = 0;
        return (int)(to - text);
    }
    int exponent, count = round_digits(digit, &exponent, number < 0 ? -number : number);
    bool scientific = exponent <= -4 || exponent > SIGNIFICANT;
    int whole = scientific ? 1 : exponent;
    if (whole <= 0) {
        *to++ = '0';
        *to++ = '.';
        for (int i = whole; i < 0; i++)
            *to++ = '0';
    }
    for (int i = 0; i < count || i < whole; i++) {
        if (i == whole && whole > 0)
            *to++ = '.';
        *to++ = (char)(i < count ? digit[i] : '0');
    }
    if (scientific) {
        int power = exponent - 1;
        to += snprintf(to, 8, "e%c%02d", power < 0 ? '-' : '+', power < 0 ? -power : power);
    }
    *to = 0;
    return (int)(to - text);
}

static int write_point(char text[ISO_DATUM_TEXT_SIZE], iso_vec2 point, bool as_file) {
    char x[ISO_DATUM_TEXT_SIZE], y[ISO_DATUM_TEXT_SIZE];
    iso_datum_write_number(x, point.x);
    iso_datum_write_number(y, point.y);
    return snprintf(text, ISO_DATUM_TEXT_SIZE, as_file ? "%.24s,%.24s" : "[%.24s, %.24s]", x, y);
}

int iso_datum_write(char text[ISO_DATUM_TEXT_SIZE], const iso_datum *datum, bool as_file) {
    const char *word = "";
    switch (datum->kind) {
    case ISO_DATUM_BOOL:
        word = as_file ? (datum->flag ? "1" : "0") : datum->flag ? "true" : "false";
        break;
    case ISO_DATUM_INTEGER:
        return snprintf(text, ISO_DATUM_TEXT_SIZE, "%d", (int)datum->integer);
    case ISO_DATUM_NUMBER: {
        int length = iso_datum_write_number(text, datum->number);
        if (as_file && datum->percent) {
            text[length++] = '%';
            text[length] = 0;
        }
        return length;
    }
    case ISO_DATUM_POINT:
        return write_point(text, datum->point, as_file);
    case ISO_DATUM_NIL:
        word = "nil";
        break;
    default:
        break;
    }
    return snprintf(text, ISO_DATUM_TEXT_SIZE, "%s", word);
}

static double scale_ten(double number, int power) {
    static const double ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    for (; power > 22; power -= 22)
        number *= ten[22];
    for (; power < -22; power += 22)
        number /= ten[22];
    return power < 0 ? number / ten[-power] : number * ten[power];
}

/* Digits beyond what an int64 holds count only by their place. */
static int32_t read_digits(int64_t *value, int *power, const char *text, int32_t length, int32_t at,
                           int step) {
    for (; at < length && text[at] >= '0' && text[at] <= '9'; at++) {
        if (*value < INT64_MAX / 100) {
            *value = 10 * *value + (text[at] - '0');
            *power -= step;
        } else {
            *power += 1 - step;
        }
    }
    return at;
}

static int32_t read_exponent(int *power, const char *text, int32_t length, int32_t at) {
    int32_t digits = at + 1;
    if (at >= length || (text[at] != 'e' && text[at] != 'E'))
        return at;
    bool negative = digits < length && text[digits] == '-';
    if (digits < length && (text[digits] == '-' || text[digits] == '+'))
        digits++;
    int64_t value = 0;
    int ignored = 0;
    int32_t end = read_digits(&value, &ignored, text, length, digits, 0);
    if (end == digits)
        return at;
    *power += (int)(value > 1000 ? 1000 : value) * (negative ? -1 : 1);
    return end;
}

bool iso_datum_read_number(iso_datum *number, const char *text, int32_t length, int32_t *used) {
    int64_t value = 0;
    int power = 0;
    int32_t whole = read_digits(&value, &power, text, length, 0, 0), end = whole;
    if (whole < length && text[whole] == '.')
        end = read_digits(&value, &power, text, length, whole + 1, 1);
    if (end == 0 || (end == 1 && whole == 0))
        return false;
    int32_t behind = read_exponent(&power, text, length, end);
    *used = behind;
    if (behind == whole) {
        *number = iso_datum_integer((int32_t)value);
        return value <= INT32_MAX && power == 0;
    }
    *number = iso_datum_number(scale_ten((double)value, power));
    return number->number <= 1e300;
}
