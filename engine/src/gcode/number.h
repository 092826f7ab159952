/* Decimal text from integers, the digits taken three at a time from a table.
 *
 * Like PrusaSlicer's, the numbers of moves have neither trailing zeros nor a zero before the point:
 * -.5, 12, 107.25. Each function writes at `to` and returns the end; nothing is terminated. */
#ifndef ISO_GCODE_NUMBER_H
#define ISO_GCODE_NUMBER_H

#include <stdint.h>
#include <string.h>

extern const char iso_number_fraction[1000][4];      /* ".000" to ".999" */
extern const uint8_t iso_number_fraction_size[1000]; /* without trailing zeros: 0, 2, 3 or 4 */

enum { ISO_NUMBER_MAX = 32 /* no number is longer */ };

/* Any integer. */
char *iso_put_integer(char *to, int64_t value);

/* value / 10^decimals, decimals 0 to 9, as people write it: 0.35, -12, 107.25. */
char *iso_put_decimal(char *to, int64_t value, int decimals);

/* 0 to 999; a 0 only if `zero`. */
static inline char *iso_put_below_1000(char *to, uint32_t value, int zero) {
    const char *digit = iso_number_fraction[value] + 1;
    uint32_t skipped = value >= 100 ? 0 : value >= 10 ? 1 : value > 0 || zero ? 2 : 3;
    memcpy(to, digit + skipped, 3 - skipped);
    return to + 3 - skipped;
}

/* Thousandths. */
static inline char *iso_put_thousandths(char *to, int32_t value) {
    uint32_t magnitude = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    uint32_t whole = magnitude / 1000, fraction = magnitude % 1000;
    *to = '-';
    to += value < 0;
    if (whole < 1000)
        to = iso_put_below_1000(to, whole, fraction == 0);
    else
        to = iso_put_integer(to, whole);
    memcpy(to, iso_number_fraction[fraction], 4);
    return to + iso_number_fraction_size[fraction];
}

/* Hundred-thousandths, as E is counted. */
static inline char *iso_put_hundred_thousandths(char *to, int64_t value) {
    uint64_t magnitude = value < 0 ? 0u - (uint64_t)value : (uint64_t)value;
    uint64_t whole = magnitude / 100000;
    uint32_t fraction = (uint32_t)(magnitude % 100000);
    uint32_t high = fraction / 100, low = fraction % 100 * 10;
    *to = '-';
    to += value < 0;
    if (whole < 1000)
        to = iso_put_below_1000(to, (uint32_t)whole, fraction == 0);
    else
        to = iso_put_integer(to, (int64_t)whole);
    memcpy(to, iso_number_fraction[high], 4);
    if (low == 0)
        return to + iso_number_fraction_size[high];
    memcpy(to + 4, iso_number_fraction[low] + 1, 2);
    return to + 3 + iso_number_fraction_size[low];
}

#endif
