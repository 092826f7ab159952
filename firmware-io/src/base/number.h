/* Decimal numbers as G-code has them: [+-]digits[.digits], no exponent, whatever the locale. */
#ifndef FIO_BASE_NUMBER_H
#define FIO_BASE_NUMBER_H

/* Larger magnitudes are read as infinity: no coordinate, speed or time of a printer is near it. */
#define FIO_NUMBER_LIMIT 1e9

/* Read a number from [text, end). Returns what follows it, or `text` itself (and *value untouched)
 * if there is no digit. Correctly rounded up to 15 significant digits; digits past the 18th are
 * dropped. */
const char *fio_number_read(double *value, const char *text, const char *end);

#endif
