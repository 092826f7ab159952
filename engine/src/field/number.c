#include "field/number.h"

#include <stdint.h>

#include "base/series.h"

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool number_begins(const char *at) {
    return is_digit(*at) || (*at == '.' && is_digit(at[1]));
}

/* Digits behind the 18th only count as places. */
static void read_digits(int64_t *digits, int32_t *exponent, const char **at, int32_t place) {
    for (; is_digit(**at); (*at)++) {
        if (*digits < 100000000000000000) {
            *digits = *digits * 10 + (**at - '0');
            *exponent -= place;
        } else if (*exponent < 100000) {
            *exponent += 1 - place;
        }
    }
}

static bool read_exponent(int32_t *exponent, const char **at) {
    if (**at != 'e' && **at != 'E')
        return true;
    int32_t power = 0;
    (*at)++;
    bool negative = **at == '-';
    *at += **at == '-' || **at == '+';
    if (!is_digit(**at))
        return false;
    for (; is_digit(**at); (*at)++)
        power = power < 100000 ? power * 10 + (**at - '0') : power;
    *exponent += negative ? -power : power;
    return true;
}

/* The C library's way depends on the locale. */
bool number_read(double *number, const char **at) {
    int64_t digits = 0;
    int32_t exponent = 0;
    read_digits(&digits, &exponent, at, 0);
    if (**at == '.') {
        (*at)++;
        read_digits(&digits, &exponent, at, 1);
    }
    if (!read_exponent(&exponent, at))
        return false;
    double value = (double)digits;
    for (; exponent < -200 && value > 0; exponent += 200)
        value /= 1e200;
    *number = exponent < 0 ? value / series_power(10, -exponent)
              : value > 0  ? value * series_power(10, exponent)
                           : 0;
    return true;
}
