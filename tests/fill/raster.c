#include "raster.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static size_t pixels(const raster *r) {
    return (size_t)r->width * (size_t)r->height;
}

static int compare(const void *one, const void *other) {
    double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

/* Even and odd: regions have no overlaps. */
static void want_row(raster *r, const iso_region *region, int row, double *cross) {
    double y = r->y + (row + 0.5) * r->pixel;
    int count = 0;
    for (int c = 0; c < region->count; c++)
        for (int i = region->first[c + 1] - 1, k = region->first[c]; k < region->first[c + 1];
             i = k++) {
            iso_point a = region->point[i], b = region->point[k];
            if ((a.y > y) != (b.y > y))
                cross[count++] = a.x + (y - a.y) / ((double)b.y - a.y) * ((double)b.x - a.x);
        }
    qsort(cross, (size_t)count, sizeof *cross, compare);
    for (int i = 0; i + 1 < count; i += 2)
        for (int k = (int)ceil((cross[i] - r->x) / r->pixel - 0.5);
             r->x + (k + 0.5) * r->pixel < cross[i + 1]; k++)
            r->wanted[(size_t)row * (size_t)r->width + (size_t)k] = 1;
}

void raster_new(raster *r, const iso_region *region, double pixel) {
    double low[2] = {1e18, 1e18}, high[2] = {-1e18, -1e18}, around = 5000;
    for (int i = 0; i < region->first[region->count]; i++) {
        double at[2] = {region->point[i].x, region->point[i].y};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k] - around);
            high[k] = fmax(high[k], at[k] + around);
        }
    }
    *r = (raster){.x = low[0], .y = low[1], .pixel = pixel};
    r->width = (int)((high[0] - low[0]) / pixel) + 1;
    r->height = (int)((high[1] - low[1]) / pixel) + 1;
    r->wanted = calloc(pixels(r), 1);
    r->covered = calloc(pixels(r), 1);
    r->times = calloc(pixels(r), 1);
    double *cross = malloc((size_t)region->first[region->count] * sizeof *cross);
    for (int row = 0; row < r->height; row++)
        want_row(r, region, row, cross);
    free(cross);
}

void raster_free(raster *r) {
    free(r->wanted);
    free(r->covered);
    free(r->times);
}

static int clamped(double x, int most) {
    return x < 0 ? 0 : x > most ? most : (int)x;
}

static void draw_piece(raster *r, const iso_path_vertex *a, iso_point b, double height) {
    double dx = (double)b.x - a->at.x, dy = (double)b.y - a->at.y, length = hypot(dx, dy);
    double flat = a->area / height / 2, around = flat + height * (1 - pi / 4) / 2;
    int left = clamped((fmin(a->at.x, b.x) - around - r->x) / r->pixel, r->width);
    int right = clamped((fmax(a->at.x, b.x) + around - r->x) / r->pixel + 1, r->width);
    int low = clamped((fmin(a->at.y, b.y) - around - r->y) / r->pixel, r->height);
    int high = clamped((fmax(a->at.y, b.y) + around - r->y) / r->pixel + 1, r->height);
    for (int row = low; row < high && length > 0; row++)
        for (int column = left; column < right; column++) {
            double x = r->x + (column + 0.5) * r->pixel - a->at.x;
            double y = r->y + (row + 0.5) * r->pixel - a->at.y;
            double along = (x * dx + y * dy) / length, off = fabs(x * dy - y * dx) / length;
            double beyond = along < 0 ? -along : along > length ? along - length : 0;
            size_t at = (size_t)row * (size_t)r->width + (size_t)column;
            r->covered[at] |= hypot(beyond, off) <= around;
            r->times[at] = (unsigned char)(r->times[at] + (beyond == 0 && off <= flat));
        }
}

void raster_draw(raster *r, const iso_paths *paths, double height) {
    for (int p = 0; p < paths->count; p++)
        for (int k = 0; k + 1 < paths->path[p].count; k++) {
            const iso_path_vertex *vertex = paths->vertex + paths->path[p].first + k;
            draw_piece(r, vertex, vertex[1].at, height);
        }
}

static double part(const raster *r, double count) {
    double wanted = 0;
    for (size_t i = 0; i < pixels(r); i++)
        wanted += r->wanted[i];
    return count / wanted;
}

double raster_under(const raster *r) {
    double count = 0;
    for (size_t i = 0; i < pixels(r); i++)
        count += r->wanted[i] && !r->covered[i];
    return part(r, count);
}

double raster_over(const raster *r) {
    double count = 0;
    for (size_t i = 0; i < pixels(r); i++)
        count += r->times[i] > r->wanted[i] ? r->times[i] - r->wanted[i] : 0;
    return part(r, count);
}
