/* A mould is material exactly where it is to be: points at random, told by formulas. */
#include <isoslice/channel.h>
#include <isoslice/solid.h>

#include <stdbool.h>
#include <stdlib.h>

#include "base/random.h"
#include "check.h"
#include "shapes.h"

enum { POINTS = 20000, SIDES = 48 };

static const shape cone = {cone_radius, 0, 40, 1, 1, 0, 360, 21};

/* Signed, of the cone; a few hundredths wrong near its edges. */
static double to_cone(iso_vec3 p) {
    double slope = (hypot(p.x, p.y) - 30 + p.z / 2) * 2 / sqrt(5);
    return fmax(slope, fmax(-p.z, p.z - 40));
}

static double to_lines(const iso_multilink *lines, iso_vec3 p) {
    double best = INFINITY;
    for (int32_t a = 0; a < lines->size; a++) {
        const double *g = lines->g + 3 * a, *h = lines->g + 3 * iso_map_at(&lines->map[0], a);
        double e[3] = {h[0] - g[0], h[1] - g[1], h[2] - g[2]};
        double d[3] = {p.x - g[0], p.y - g[1], p.z - g[2]};
        double square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
        double t = square > 0 ? (d[0] * e[0] + d[1] * e[1] + d[2] * e[2]) / square : 0;
        t = fmin(fmax(t, 0), 1);
        double x = d[0] - t * e[0], y = d[1] - t * e[1], z = d[2] - t * e[2];
        best = fmin(best, sqrt(x * x + y * y + z * z));
    }
    return best;
}

static void check_points(iso_channel_ports ports, iso_channel_side side) {
    iso_channel_options options = iso_channel_defaults();
    iso_mesh part, mould;
    iso_channels *channels;
    iso_coloured_link lines;
    iso_solid *solid;
    float *triangle;
    int64_t count;
    int told = 0, in_part = 0, in_channel = 0;
    options.ports = ports;
    options.side = side;
    CHECK_OK(iso_channel_section_parse(&options.section, "round:8", SIDES));
    shape_mesh(&part, &cone);
    CHECK_OK(iso_channels_new(&channels, &part, &options));
    const iso_channel_figures *f = iso_channels_figures(channels);
    CHECK_OK(iso_channels_centrelines(&lines, channels));
    CHECK_OK(iso_channels_triangles(&triangle, &count, channels, ISO_CHANNEL_MOULD));
    CHECK_OK(iso_mesh_from_triangles(&mould, triangle, count));
    CHECK_OK(iso_solid_new(&solid, &mould, 1));
    iso_vec3 *point = malloc(POINTS * sizeof *point);
    int32_t *winding = malloc(POINTS * sizeof *winding);
    iso_vec3 low = f->box_min, high = f->box_max;
    uint64_t seed = 7;
    for (int i = 0; i < POINTS; i++) {
        double u = random_unit(&seed), v = random_unit(&seed), w = random_unit(&seed);
        if (i % 2 == 0) { /* near a channel */
            const double *g =
                lines.link.g + 3 * (int64_t)(random_next(&seed) % (uint64_t)lines.link.size);
            point[i] =
                (iso_vec3){g[0] + 12 * (u - 0.5), g[1] + 12 * (v - 0.5), g[2] + 12 * (w - 0.5)};
        } else {
            point[i] = (iso_vec3){low.x - 5 + u * (high.x - low.x + 10),
                                  low.y - 5 + v * (high.y - low.y + 10),
                                  low.z - 5 + w * (high.z - low.z + 10)};
        }
    }
    iso_winding_options rays = {6, 1}; /* all of them must agree */
    CHECK_OK(iso_solid_winding(winding, NULL, solid, point, POINTS, &rays));
    for (int i = 0; i < POINTS; i++) {
        iso_vec3 p = point[i];
        double out = fmax(fmax(low.x - p.x, p.x - high.x),
                          fmax(fmax(low.y - p.y, p.y - high.y), fmax(low.z - p.z, p.z - high.z)));
        double part_off = to_cone(p), channel_off = to_lines(&lines.link, p) - 4;
        if (fabs(out) < 1e-3 || fabs(part_off) < 0.02 || fabs(channel_off) < 0.05)
            continue; /* between the formula and its polygons */
        bool material = out < 0 && part_off > 0 && channel_off > 0;
        CHECK_EQUAL(material, winding[i]);
        told++;
        in_part += part_off < 0;
        in_channel += channel_off < 0;
    }
    CHECK(told > POINTS * 9 / 10 && in_part > 300 && in_channel > 1000);
    free(point);
    free(winding);
    iso_channels_release(triangle);
    iso_solid_free(solid);
    iso_mesh_free(&mould);
    iso_multilink_free(&lines.link);
    iso_channels_free(channels);
    iso_mesh_free(&part);
}

static void test_closed_rings(void) {
    check_points(ISO_CHANNEL_CLOSED, ISO_CHANNEL_FRONT);
}
static void test_parallel_ports(void) {
    check_points(ISO_CHANNEL_PARALLEL, ISO_CHANNEL_RIGHT);
}
static void test_a_series(void) {
    check_points(ISO_CHANNEL_SERIES, ISO_CHANNEL_BACK);
}

int main(void) {
    RUN(test_closed_rings);
    RUN(test_parallel_ports);
    RUN(test_a_series);
    return check_verdict();
}
