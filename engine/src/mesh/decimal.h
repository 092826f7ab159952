/* Decimal text to the nearest float, whatever the locale. */
#ifndef ISO_MESH_DECIMAL_H
#define ISO_MESH_DECIMAL_H

/* Parse [+-] digits [. digits] [e [+-] digits] at `text`, which ends before `end`. Returns the
 * first character after the number, or NULL if there is none at `text`. Too large a value gives
 * infinity, too small a one zero; in between it is rounded to nearest, ties to even. "nan", "inf"
 * and "infinity" in any case are numbers too. */
const char *iso_decimal_parse(float *value, const char *text, const char *end);

#endif
