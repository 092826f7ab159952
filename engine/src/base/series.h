/* Exponentials, logarithms and angles by series of our own, the same on every machine: the C
 * library's differ from one to the next.
 *
 * Within 2e-15 of the truth, relative to it. Zeros, infinities, NaN and what is out of range as C's
 * functions have them. Sine, cosine and tangent of more than a million radians take the angle as if
 * it was off by half its last bit, which a double doesn't know better anyway. */
#ifndef ISO_BASE_SERIES_H
#define ISO_BASE_SERIES_H

double series_exp(double x);
double series_log(double x);
/* Exact for powers -4 to 4 and 0.5 as far as a chain of products, or a root, is; whole powers to
 * 1024 in doubled precision, rounded once. */
double series_power(double base, double exponent);

void series_sine_cosine(double *sine, double *cosine, double radians);
double series_tangent(double radians);

double series_arctangent(double x);
double series_arctangent2(double y, double x);
double series_arcsine(double x);
double series_arccosine(double x);

double series_hypotenuse(double x, double y);

#endif
