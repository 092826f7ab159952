/* Values of options as text, one kind at a time. Independent of the locale. */
#ifndef ISO_CONFIG_VALUE_H
#define ISO_CONFIG_VALUE_H

#include <isoslice/config.h>

/* Longest text of a value, its end included: a text option with every byte escaped, or a full list
 * of numbers. */
#define ISO_VALUE_TEXT_SIZE 65536

/* Room for a value of any kind. */
typedef union iso_value {
    bool flag;
    int32_t integer; /* words too */
    double number;
    iso_relative relative;
    char text[ISO_TEXT_SIZE];
    iso_place place;
    iso_points points;
    iso_numbers numbers;
} iso_value;

/* Read a decimal number, rounded to nine places, |x| <= 10^6. Moves *text behind it. */
bool iso_number_read(double *number, const char **text);
/* Write it back, as short as can be; returns the length, < 32. */
int iso_number_write(char text[32], double number);

/* Bytes of a kind. */
size_t iso_value_size(iso_option_kind kind);
/* NULL behind the last one, and for kinds that have no words. */
const char *iso_value_word(iso_option_kind kind, int32_t i);

/* On failure returns what is wrong, to be put behind the value; NULL if all is well. */
const char *iso_value_parse(iso_value *value, const iso_option_info *info, const char *text);
size_t iso_value_format(char *text, size_t size, const void *value, iso_option_kind kind);

#endif
