#include "base/angle.h"

#include <math.h>

/* For 0 <= x <= pi / 4 from their series; 9 terms leave less than 1e-16. */
static void series(double *sine, double *cosine, double x) {
    double square = x * x, s = 1, c = 1;
    for (int i = 9; i > 0; i--) {
        s = 1 - s * square / (2 * i * (2 * i + 1));
        c = 1 - c * square / (2 * i * (2 * i - 1));
    }
    *sine = s * x;
    *cosine = c;
}

void iso_sine_cosine(double *sine, double *cosine, double degrees) {
    const double half = 0.70710678118654752440, radian = 3.14159265358979323846 / 180;
    double turned = fmod(degrees, 360); /* exact */
    if (turned < 0)
        turned += 360;
    if (turned >= 360) /* a tiny negative angle, rounded */
        turned = 0;
    int quarter = (int)(turned / 90);
    double rest = turned - 90 * quarter, s = half, c = half, swap;
    if (rest < 45)
        series(&s, &c, rest * radian);
    else if (rest > 45)
        series(&c, &s, (90 - rest) * radian);
    for (; quarter > 0; quarter--)
        swap = s, s = c, c = -swap;
    *sine = s + 0.0; /* -0 + 0 = 0 */
    *cosine = c + 0.0;
}
