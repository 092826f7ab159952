/* Channels as bodies, and moulds that have them: closed, and of the volume that their making says.
 */
#include <isoslice/channel.h>

#include <stdbool.h>
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "shapes.h"

#define PI 3.14159265358979323846

static const shape cone = {cone_radius, 0, 40, 1, 1, 0, 72, 21};
static const shape leaning = {cone_radius, 0, 40, 1, 0.8, 0.3, 72, 21};

static iso_channel_options options_of(const char *section, iso_channel_ports ports) {
    iso_channel_options options = iso_channel_defaults();
    CHECK_OK(iso_channel_section_parse(&options.section, section, 24));
    options.ports = ports;
    options.bend = 5;
    options.samples = 100;
    options.levels = 33; /* few, for speed */
    return options;
}

static double length_of(const iso_multilink *link, int32_t colour) {
    double sum = 0;
    for (int32_t a = 0; a < link->size; a++) {
        const double *p = link->g + 3 * a, *q = link->g + 3 * iso_map_at(&link->map[0], a);
        if (iso_map_at(&link->projection[0], a) == colour)
            sum += sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                        (p[2] - q[2]) * (p[2] - q[2]));
    }
    return sum;
}

static double volume_of(const float *triangle, int64_t count) {
    double six = 0;
    for (int64_t t = 0; t < count; t++) {
        const float *p = triangle + 9 * t;
        six += p[0] * ((double)p[4] * p[8] - (double)p[5] * p[7]) +
               p[1] * ((double)p[5] * p[6] - (double)p[3] * p[8]) +
               p[2] * ((double)p[3] * p[7] - (double)p[4] * p[6]);
    }
    return six / 6;
}

/* A closed channel is a square patch and a torus. */
static void check_patch(const iso_channels *channels, int32_t number) {
    iso_square_link skin;
    iso_square_patch patch;
    iso_double_link surface;
    iso_surface_counts counts;
    CHECK_OK(iso_channels_skin(&skin, channels, number));
    CHECK_OK(iso_multilink_validate(&skin.link));
    CHECK_OK(iso_square_patch_from_square_link(&patch, &skin));
    CHECK_OK(iso_multilink_validate(&patch.link));
    CHECK_OK(iso_double_link_from_square_patch(&surface, &patch));
    CHECK_OK(iso_double_link_count(&counts, &surface));
    CHECK_EQUAL(0, counts.euler);
    CHECK_EQUAL(1, counts.parts);
    CHECK_EQUAL(skin.link.size, counts.faces);
    iso_multilink_free(&surface.link);
    iso_multilink_free(&patch.link);
    iso_multilink_free(&skin.link);
}

static void check_mesh(const float *triangle, int64_t count, double volume, int64_t shells) {
    iso_mesh mesh;
    CHECK_OK(iso_mesh_from_triangles(&mesh, triangle, count));
    const iso_mesh_defects *d = &mesh.defects;
    CHECK_EQUAL(0, d->degenerate + d->duplicate + d->cancelled + d->welded_vertices + d->bad_edges +
                       d->flipped_triangles + d->inverted_shells + d->holes_closed);
    CHECK_EQUAL(shells, d->shells);
    CHECK_EQUAL(count, mesh.triangle_count);
    CHECK_NEAR(volume, iso_mesh_volume(&mesh), 1e-4 * volume);
    iso_mesh_free(&mesh);
}

/* All that can be said about one set of channels. */
static void check_all(const shape *s, const iso_channel_options *options) {
    iso_mesh mesh;
    iso_channels *channels;
    iso_coloured_link middle;
    float *triangle;
    int64_t count;
    shape_mesh(&mesh, s);
    bool made = CHECK_OK(iso_channels_new(&channels, &mesh, options));
    if (!made) {
        iso_mesh_free(&mesh);
        return;
    }
    const iso_channel_figures *f = iso_channels_figures(channels);
    double area = iso_channel_section_area(&options->section), length = 0;
    bool closed = options->ports == ISO_CHANNEL_CLOSED;
    CHECK_OK(iso_channels_check(channels));
    CHECK_OK(iso_channels_centrelines(&middle, channels));
    CHECK_OK(iso_multilink_validate(&middle.link));
    for (int32_t i = 0; i < f->channel_count; i++) {
        length += length_of(&middle.link, i);
        if (closed)
            check_patch(channels, i);
    }
    CHECK_NEAR(f->length, length, 1e-9 * length);
    CHECK_OK(iso_channels_triangles(&triangle, &count, channels, ISO_CHANNEL_SKINS));
    CHECK_NEAR(1, volume_of(triangle, count) / (area * length), 2e-4);
    check_mesh(triangle, count, f->volume, f->channel_count);
    iso_channels_release(triangle);
    iso_vec3 size = {f->box_max.x - f->box_min.x, f->box_max.y - f->box_min.y,
                     f->box_max.z - f->box_min.z};
    double mould = size.x * size.y * size.z - iso_mesh_volume(&mesh) - area * length;
    CHECK_OK(iso_channels_triangles(&triangle, &count, channels, ISO_CHANNEL_MOULD));
    CHECK_NEAR(1, volume_of(triangle, count) / mould, 5e-4);
    check_mesh(triangle, count, mould, closed ? 2 + f->channel_count : 2);
    iso_channels_release(triangle);
    iso_multilink_free(&middle.link);
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
}

static void test_closed_rings_of_every_section(void) {
    static const char *const section[] = {"round:8",  "square:6",    "rect:8x5",
                                          "oval:4x8", "polygon:6:7", "polygon:3:6"};
    for (size_t i = 0; i < sizeof section / sizeof *section; i++) {
        iso_channel_options options = options_of(section[i], ISO_CHANNEL_CLOSED);
        options.bend = 6;
        check_all(&cone, &options);
    }
}

static void test_ports_on_every_side(void) {
    for (int side = 0; side < ISO_CHANNEL_SIDE_COUNT; side++) {
        iso_channel_options options = options_of("round:8", ISO_CHANNEL_PARALLEL);
        options.side = (iso_channel_side)side;
        check_all(&leaning, &options);
        options.ports = ISO_CHANNEL_SERIES;
        check_all(&leaning, &options);
    }
}

static void test_pointwise_rings(void) {
    iso_channel_options options = options_of("round:6", ISO_CHANNEL_CLOSED);
    options.mode = ISO_CHANNEL_POINTWISE;
    options.pitch = 12;
    check_all(&leaning, &options);
}

/* A section keeps its side to the part: of a rectangle 8 mm along it and 3 off it the tube is 8 mm
 * high and 3 wide where the wall is upright. */
static void test_a_section_faces_the_part(void) {
    static const shape post = {cylinder_radius, 0, 40, 1, 1, 0, 90, 2};
    iso_channel_options options = options_of("rect:8x3", ISO_CHANNEL_CLOSED);
    iso_mesh mesh;
    iso_channels *channels;
    iso_square_link skin;
    shape_mesh(&mesh, &post);
    CHECK_OK(iso_channels_new(&channels, &mesh, &options));
    CHECK_OK(iso_channels_skin(&skin, channels, 0));
    for (int32_t a = 0; a < skin.link.size; a++) {
        const double *p = skin.link.g + 3 * a;
        double r = hypot(p[0], p[1]);
        CHECK_NEAR(4, fabs(p[2] - 10), 0.01);
        CHECK_NEAR(1.5, fabs(r - 30), 0.05);
    }
    iso_multilink_free(&skin.link);
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
}

/* Middles are as far off the part as they are to be; the distance to a cone is known. */
static void test_the_depth(void) {
    iso_channel_options options = options_of("round:8", ISO_CHANNEL_CLOSED);
    iso_mesh mesh;
    iso_channels *channels;
    iso_coloured_link middle;
    options.pitch = 8;
    shape_mesh(&mesh, &cone);
    CHECK_OK(iso_channels_new(&channels, &mesh, &options));
    CHECK_OK(iso_channels_centrelines(&middle, channels));
    for (int32_t a = 0; a < middle.link.size; a++) {
        const double *p = middle.link.g + 3 * a;
        double off = (hypot(p[0], p[1]) - 30 + p[2] / 2) * 2 / sqrt(5);
        CHECK_NEAR(10, off, 0.05);
    }
    CHECK_NEAR(6, iso_channels_figures(channels)->to_part.thickness, 0.05);
    iso_multilink_free(&middle.link);
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
}

/* The square-link, sliced as any double-link is, has the rings that the channels came from. */
static void test_rings_are_iso_slices_of_the_square_link(void) {
    iso_channel_options options = options_of("round:4", ISO_CHANNEL_CLOSED);
    iso_mesh mesh;
    iso_channels *channels;
    iso_square_link tower;
    iso_double_link surface;
    iso_coloured_link rings;
    double *height, *dart_height;
    options.pitch = 5;
    shape_mesh(&mesh, &cone);
    CHECK_OK(iso_channels_new(&channels, &mesh, &options));
    const iso_channel_figures *f = iso_channels_figures(channels);
    CHECK_EQUAL(9, f->ring_count);
    CHECK_OK(iso_channels_tower(&tower, &height, channels, 0));
    CHECK_OK(iso_multilink_validate(&tower.link));
    CHECK_OK(iso_double_link_from_square_link(&surface, &tower, ISO_BOUNDARY_FANNED));
    dart_height = malloc((size_t)surface.link.size * sizeof *dart_height);
    double level[9];
    for (int k = 0; k < 9; k++)
        level[k] = f->ring[k].height;
    for (int32_t d = 0; d < surface.link.size && dart_height; d++) {
        int32_t v = iso_double_link_vertex(&surface, d);
        dart_height[d] = v < tower.link.size                       ? height[v]
                         : surface.link.g[3 * (int64_t)d + 2] > 20 ? 1e3
                                                                   : -1;
    }
    CHECK_OK(iso_slice_double_link(&rings, &surface, dart_height, level, 9));
    for (int k = 0; k < 9; k++) {
        double length = length_of(&rings.link, k);
        CHECK_NEAR(f->ring[k].length, length, 1e-9 * length);
    }
    for (int32_t a = 0; a < rings.link.size; a++)
        CHECK_NEAR(f->ring[iso_map_at(&rings.link.projection[0], a)].z, rings.link.g[3 * a + 2],
                   1e-9);
    free(dart_height);
    iso_channels_release(height);
    iso_multilink_free(&rings.link);
    iso_multilink_free(&surface.link);
    iso_multilink_free(&tower.link);
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
}

/* Rings between two levels lie on the chord, a little within the sphere: their place is the one
 * right above them. */
static void test_the_reported_error_is_the_true_one(void) {
    static const shape zone = {sphere_radius, -25, 25, 1, 1, 0, 180, 121};
    iso_channel_options options = options_of("round:4", ISO_CHANNEL_CLOSED);
    iso_mesh mesh;
    iso_channels *channels;
    double worst = 0, before = 0;
    options.pitch = 5;
    options.levels = 16; /* coarse, so that there is an error */
    shape_mesh(&mesh, &zone);
    CHECK_OK(iso_channels_new(&channels, &mesh, &options));
    const iso_channel_figures *f = iso_channels_figures(channels);
    CHECK(f->ring_count >= 10);
    for (int32_t k = 0; k < f->ring_count; k++) {
        double at = 30 * atan2(f->ring[k].z, f->ring[k].length / (2 * PI));
        if (k > 0)
            worst = fmax(worst, fabs((at - before) / 5 - 1));
        before = at;
    }
    printf("true %.4f %%, reported %.4f %%\n", 100 * worst, 100 * f->pitch_max);
    CHECK(worst > 5e-4);
    CHECK_NEAR(worst, f->pitch_max, 0.25 * worst);
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
}

static void test_the_same_bytes_again(void) {
    iso_channel_options options = options_of("round:8", ISO_CHANNEL_SERIES);
    iso_mesh mesh;
    float *triangle[2];
    int64_t count[2];
    shape_mesh(&mesh, &leaning);
    for (int i = 0; i < 2; i++) {
        iso_channels *channels;
        CHECK_OK(iso_channels_new(&channels, &mesh, &options));
        CHECK_OK(iso_channels_triangles(&triangle[i], &count[i], channels, ISO_CHANNEL_MOULD));
        iso_channels_free(channels);
    }
    CHECK_EQUAL(count[0], count[1]);
    CHECK(memcmp(triangle[0], triangle[1], (size_t)count[0] * 9 * sizeof(float)) == 0);
    iso_channels_release(triangle[0]);
    iso_channels_release(triangle[1]);
    iso_mesh_free(&mesh);
}

static void test_no_memory(void) {
    static const shape coarse = {cone_radius, 0, 40, 1, 1, 0, 16, 5};
    iso_channel_options options = options_of("round:8", ISO_CHANNEL_SERIES);
    iso_mesh mesh;
    options.levels = 9;
    options.samples = 40;
    shape_mesh(&mesh, &coarse);
    int64_t n = 0;
    for (iso_status status = ISO_NO_MEMORY; status == ISO_NO_MEMORY; n += n < 40 ? 1 : 29) {
        iso_channels *channels;
        float *triangle = NULL;
        int64_t count;
        iso_fail_allocation_after(n);
        status = iso_channels_new(&channels, &mesh, &options);
        if (status == ISO_OK)
            status = iso_channels_triangles(&triangle, &count, channels, ISO_CHANNEL_MOULD);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        iso_channels_release(triangle);
        iso_channels_free(channels);
    }
    CHECK(n > 100);
    iso_mesh_free(&mesh);
}

/* Two posts on a plate: three towers, the ways along both posts go on from the plate's. */
static void test_towers_branch(void) {
    static const double low[3][3] = {{-40, -20, 0}, {-35, -12, 10}, {15, -12, 10}};
    static const double high[3][3] = {{40, 20, 10}, {-15, 12, 50}, {35, 12, 50}};
    iso_channel_options options = options_of("round:3", ISO_CHANNEL_CLOSED);
    iso_mesh mesh;
    iso_channels *channels;
    options.pitch = 12;
    options.depth = 5;
    plate_mesh(&mesh, low, high, 3);
    CHECK_OK(iso_channels_new(&channels, &mesh, &options));
    CHECK_OK(iso_channels_check(channels));
    const iso_channel_figures *f = iso_channels_figures(channels);
    CHECK_EQUAL(3, f->tower_count);
    CHECK(f->ring_count > 5 && f->ring_count % 2 == 1);
    /* the same heights on both, 12 mm apart, and as far apart as that in z, for posts are upright
     */
    for (int32_t i = 1, half = f->ring_count / 2; i <= half; i++) {
        CHECK_EQUAL(f->ring[i].tower + 1, f->ring[i + half].tower);
        CHECK_NEAR(f->ring[i].height, f->ring[i + half].height, 1e-9);
        CHECK(f->ring[i].height > f->ring[i].z + 8); /* the way across the plate comes on top */
        if (i > 1)
            CHECK_NEAR(12, f->ring[i].z - f->ring[i - 1].z, 1e-6);
    }
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
}

/* The way up a box and over its top is known: rings on the side are as high as it says, those on
 * the top as far from the edge. */
static void test_geodesic_rings_go_over_the_top(void) {
    iso_channel_options options = options_of("round:4", ISO_CHANNEL_CLOSED);
    iso_mesh mesh;
    iso_channels *channels;
    iso_coloured_link middle;
    options.mode = ISO_CHANNEL_GEODESIC;
    options.pitch = 15;
    options.depth = 6;
    options.bend = 4;
    box_mesh(&mesh, (iso_vec3){-30, -25, 0}, (iso_vec3){30, 25, 40});
    CHECK_OK(iso_channels_new(&channels, &mesh, &options));
    CHECK_OK(iso_channels_check(channels));
    const iso_channel_figures *f = iso_channels_figures(channels);
    CHECK_EQUAL(4, f->ring_count);
    CHECK_OK(iso_channels_centrelines(&middle, channels));
    for (int32_t a = 0; a < middle.link.size; a++) {
        const double *p = middle.link.g + 3 * a;
        int32_t k = iso_map_at(&middle.link.projection[0], a);
        double side = fmax(fabs(p[0]) - 30, fabs(p[1]) - 25);
        if (k < 3)
            CHECK_NEAR(7.5 + 15 * k, p[2], 1e-6);
        else
            CHECK_NEAR(46, p[2], 0.01);
        if (k < 3)
            CHECK(side > 3 && side < 6.01);
        else /* 12.5 mm over the edge */
            CHECK(side < -12.49 && side > -16);
    }
    iso_multilink_free(&middle.link);
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
}

/* Its contours have few points: what is dropped at the corner inside mustn't take both arms along.
 */
static void test_an_angle_is_followed_into_its_corner(void) {
    iso_mesh mesh;
    for (int mode = 0; mode < ISO_CHANNEL_MODE_COUNT; mode++) {
        iso_channel_options options = options_of("round:4", ISO_CHANNEL_CLOSED);
        iso_channels *channels;
        iso_coloured_link middle;
        double nearest = INFINITY;
        options.mode = (iso_channel_mode)mode;
        options.depth = 8;
        angle_mesh(&mesh);
        CHECK_OK(iso_channels_new(&channels, &mesh, &options));
        CHECK_OK(iso_channels_check(channels));
        const iso_channel_figures *f = iso_channels_figures(channels);
        CHECK_EQUAL(3, f->ring_count); /* and over the top one that is too narrow, geodesically */
        CHECK_EQUAL(mode == ISO_CHANNEL_GEODESIC, f->narrow);
        CHECK(f->folds >= 3);
        CHECK(f->to_part.thickness > 5.7);
        CHECK_OK(iso_channels_centrelines(&middle, channels));
        for (int32_t a = 0; a < middle.link.size; a++) /* (33, 33) is 8 mm off both arms */
            nearest =
                fmin(nearest, hypot(middle.link.g[3 * a] - 33, middle.link.g[3 * a + 1] - 33));
        CHECK(nearest < 3); /* rounded by 5 mm */
        /* five corners gone around, one cut short and rounded, and no loop left of it */
        double around = 280 + 5 * 90 * PI / 180 * 8 - 2 * 8 - (2 - PI / 2) * 5;
        for (int32_t k = 0; k < 3; k++)
            CHECK_NEAR(around, length_of(&middle.link, k), 2);
        iso_multilink_free(&middle.link);
        iso_channels_free(channels);
        iso_mesh_free(&mesh);
    }
}

/* There is no room in the slot, so channels pass it by. */
static void test_a_slot_is_passed_by(void) {
    iso_mesh mesh;
    slot_mesh(&mesh);
    for (int mode = 0; mode < ISO_CHANNEL_MODE_COUNT; mode++) {
        iso_channel_options options = options_of("round:4", ISO_CHANNEL_CLOSED);
        iso_channels *channels;
        iso_coloured_link middle;
        options.mode = (iso_channel_mode)mode;
        options.depth = 8;
        CHECK_OK(iso_channels_new(&channels, &mesh, &options));
        CHECK_OK(iso_channels_check(channels));
        CHECK_OK(iso_channels_centrelines(&middle, channels));
        for (int32_t a = 0; a < middle.link.size; a++) {
            const double *p = middle.link.g + 3 * a;
            if (p[0] > 20 && p[0] < 50 && p[1] > 10)
                CHECK(p[1] > 52); /* sinks in a little: the slot's edges are 5 mm to the side */
        }
        for (int32_t k = 0; k < 3; k++)
            CHECK_NEAR(240 + 2 * PI * 8, length_of(&middle.link, k), 4);
        iso_multilink_free(&middle.link);
        iso_channels_free(channels);
    }
    iso_mesh_free(&mesh);
}

static void test_bodies(void) {
    RUN(test_closed_rings_of_every_section);
    RUN(test_ports_on_every_side);
    RUN(test_pointwise_rings);
    RUN(test_the_same_bytes_again);
    RUN(test_no_memory);
}

static void test_rings(void) {
    RUN(test_a_section_faces_the_part);
    RUN(test_the_depth);
    RUN(test_rings_are_iso_slices_of_the_square_link);
    RUN(test_the_reported_error_is_the_true_one);
    RUN(test_towers_branch);
    RUN(test_geodesic_rings_go_over_the_top);
    RUN(test_an_angle_is_followed_into_its_corner);
    RUN(test_a_slot_is_passed_by);
}

/* All of them, or those that are named. */
int main(int argc, char **argv) {
    if (argc < 2 || strcmp(argv[1], "bodies") == 0)
        test_bodies();
    if (argc < 2 || strcmp(argv[1], "rings") == 0)
        test_rings();
    return check_verdict();
}
