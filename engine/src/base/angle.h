/* Sine and cosine of degrees, the same on every machine: the C library's differ from one to the
 * next. */
#ifndef ISO_BASE_ANGLE_H
#define ISO_BASE_ANGLE_H

/* Within 3e-16 of the truth; exact at multiples of 90 degrees. `degrees` must be finite. */
void iso_sine_cosine(double *sine, double *cosine, double degrees);

#endif
