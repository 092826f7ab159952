/* A surface on a grid, with a corner in each cell that it passes through, cuts off corners: of a
 * lump of one voxel 1/27 is left, of a hole as large as much. Where most is as small as that, what
 * is the rarer of the two, material or air, loses more. To move the surface by a few hundredths of
 * a voxel makes up for it. */
#include "solid/crumbs.h"

#include <math.h>

#include "base/memory.h"

/* Points that are asked about; of these, as many as tell whether the triangles fit together. */
#define POINTS (1 << 17)
#define FIRST_POINTS (1 << 12)
/* Where they do, winding numbers are whole: so far from that is not, if many points are. */
#define WHOLE 0.1
#define MANY 0.25
#define AT_ONCE 256
/* Mean length of what lines through it have inside, voxels: less is finer than the grid. */
#define CHORD 16.0
/* Of the volume: as near as it need be, and how far off it may be with no one caring. */
#define CLOSE 0.0005
#define NO_MATTER 0.005
/* Voxels: where no surface is better, this is as far as it goes. */
#define FARTHEST 1.0
#define STEPS_MAX 20

/* The surface at a level: what it encloses, and how large it is. */
static iso_status measure(double *volume, double *area, const iso_volume *made, double level) {
    float *triangle;
    int64_t count;
    *volume = *area = 0;
    ISO_TRY(volume_surface(&triangle, &count, made, level));
    for (int64_t t = 0; t < count; t++) {
        double a[3], b[3], c[3];
        for (int k = 0; k < 3; k++) {
            a[k] = (double)triangle[9 * t + k];
            b[k] = (double)triangle[9 * t + 3 + k] - a[k];
            c[k] = (double)triangle[9 * t + 6 + k] - a[k];
        }
        const double n[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                             b[0] * c[1] - b[1] * c[0]};
        *volume += (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6;
        *area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    }
    iso_release(triangle);
    return ISO_OK;
}

typedef struct shares {
    double inside, loose; /* of the points: winding half or more; not whole */
} shares;

/* By multiples of the powers of 1 / 1.2207..., the root of x^4 = x + 1: they fill a box evenly, and
 * fall in step with no grid. */
static void wind(shares *found, const iso_soup *soup, const crumbs_options *options, int count) {
    static const double step[3] = {0.81917251339616444, 0.67104360670378921, 0.54970047790197026};
    const double low[3] = {options->min.x, options->min.y, options->min.z};
    const double side[3] = {options->max.x - low[0], options->max.y - low[1],
                            options->max.z - low[2]};
    double at[3] = {0.5, 0.5, 0.5}, winding[AT_ONCE];
    iso_vec3 point[AT_ONCE];
    int64_t inside = 0, loose = 0;
    for (int first = 0; first < count; first += AT_ONCE) {
        for (int i = 0; i < AT_ONCE; i++) {
            for (int k = 0; k < 3; k++) {
                at[k] += step[k];
                at[k] -= at[k] >= 1;
            }
            point[i] = (iso_vec3){low[0] + side[0] * at[0], low[1] + side[1] * at[1],
                                  low[2] + side[2] * at[2]};
        }
        soup_winding(winding, soup, point, AT_ONCE);
        for (int i = 0; i < AT_ONCE; i++) {
            inside += winding[i] >= 0.5;
            loose += fabs(winding[i] - floor(winding[i] + 0.5)) > WHOLE;
        }
    }
    *found = (shares){(double)inside / count, (double)loose / count};
}

iso_status crumbs_level(double *level, const iso_volume *made, const iso_soup *soup,
                        const crumbs_options *options) {
    double volume, area;
    shares found;
    *level = 0;
    ISO_TRY(measure(&volume, &area, made, 0));
    if (!(4 * volume < CHORD * options->voxel * area))
        return ISO_OK;
    wind(&found, soup, options, FIRST_POINTS);
    if (found.loose < MANY)
        return ISO_OK;
    wind(&found, soup, options, POINTS);
    iso_vec3 min = options->min, max = options->max;
    double box = (max.x - min.x) * (max.y - min.y) * (max.z - min.z), wanted = found.inside * box;
    /* three standard deviations, if the points were thrown at random */
    double unsure = 3 * box * sqrt(found.inside * (1 - found.inside) / POINTS);
    if (fabs(volume - wanted) < fmax(NO_MATTER * wanted, unsure))
        return ISO_OK;
    double low = -FARTHEST, high = FARTHEST;
    for (int n = 0; n < STEPS_MAX && fabs(volume - wanted) > CLOSE * wanted; n++) {
        if (volume < wanted)
            low = *level;
        else
            high = *level;
        /* as far as the surface would move to enclose it, if that's between the bounds */
        double next = *level + (area > 0 ? (wanted - volume) / (area * options->voxel) : INFINITY);
        *level = next > low && next < high ? next : (low + high) / 2;
        ISO_TRY(measure(&volume, &area, made, *level * options->voxel));
    }
    *level *= options->voxel;
    return ISO_OK;
}
