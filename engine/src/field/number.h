/* Decimal numbers in the texts of fields, whatever the locale. */
#ifndef ISO_FIELD_NUMBER_H
#define ISO_FIELD_NUMBER_H

#include <stdbool.h>

/* Is there a digit, or a point and one? */
bool number_begins(const char *at);

/* Read one without a sign, moving *at behind it; false if its exponent, where *at is left, has no
 * digits. Up to 15 digits and 22 places come out rounded right; others within two last bits. */
bool number_read(double *number, const char **at);

#endif
