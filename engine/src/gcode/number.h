/* Decimal text from integers, the digits taken three at a time from a table.
 *
 * Like PrusaSlicer's, the numbers of moves have neither trailing zeros nor a zero before the point:
 * -.5, 12, 107.25. Each function writes at `to` and returns the end; nothing is terminated. */
#ifndef ISO_GCODE_NUMBER_H
#define ISO_GCODE_NUMBER_H

#include <stdint.h>
#include <string.h>

/* Three characters and how many of them count: 0 to 999 without leading zeros (nothing for 0), and
 * behind a point without trailing zeros (there the point is counted, too). */
typedef struct iso_three_digits {
    char text[3];
    uint8_t size;
} iso_three_digits;

extern const iso_three_digits iso_number_whole[1000];
extern const iso_three_digits iso_number_fraction[1000];

enum { ISO_NUMBER_MAX = 32 /* no number writes further */ };

/* Any integer. */
char *iso_put_integer(char *to, int64_t value);

/* value / 10^decimals, decimals 0 to 9, as people write it: 0.35, -12, 107.25. */
char *iso_put_decimal(char *to, int64_t value, int decimals);

/* Four bytes are copied whatever the size: the next thing written covers what is too much. */
static inline char *iso_put_whole(char *to, uint64_t value) {
    if (value >= 1000)
        return iso_put_integer(to, (int64_t)value);
    memcpy(to, &iso_number_whole[value], 4);
    return to + iso_number_whole[value].size;
}

/* Thousandths. */
static inline char *iso_put_thousandths(char *to, int32_t value) {
    uint32_t magnitude = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    uint32_t fraction = magnitude % 1000;
    *to = '-';
    to = iso_put_whole(to + (value < 0), magnitude / 1000);
    *to = magnitude == 0 ? '0' : '.';
    memcpy(to + 1, &iso_number_fraction[fraction], 4);
    return to + iso_number_fraction[fraction].size + (magnitude == 0);
}

/* Hundred-thousandths, as E is counted. */
static inline char *iso_put_hundred_thousandths(char *to, int64_t value) {
    uint64_t magnitude = value < 0 ? 0u - (uint64_t)value : (uint64_t)value;
    uint32_t fraction = (uint32_t)(magnitude % 100000);
    uint32_t high = fraction / 100, low = fraction % 100 * 10;
    *to = '-';
    to = iso_put_whole(to + (value < 0), magnitude / 100000);
    *to = magnitude == 0 ? '0' : '.';
    memcpy(to + 1, &iso_number_fraction[high], 4);
    memcpy(to + 4, &iso_number_fraction[low], 4);
    if (low == 0)
        return to + iso_number_fraction[high].size + (magnitude == 0);
    return to + 3 + iso_number_fraction[low].size;
}

#endif
