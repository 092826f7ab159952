#include "link/samples.h"

#include "link/surfaces.h"

const char *sample_name(int kind) {
    static const char *const name[SAMPLE_COUNT] = {
        "link",   "coloured", "cylinder", "triangulation", "patch",
        "double", "cubic",    "cube",     "filling",       "slices",
    };
    return name[kind];
}

static iso_status make_curve(iso_multilink *out, int coloured) {
    static const int32_t phi[5] = {1, 2, 0, 4, 3}, colour[5] = {2, 2, 2, 0, 0};
    static const double g[10] = {0, 0, 1, 0, 0, 1, 5, 5.1, 6, 6.25};
    iso_coloured_link with;
    iso_link without;
    iso_status status = coloured ? iso_coloured_link_new(&with, 5, phi, colour, 2, g)
                                 : iso_link_new(&without, 5, phi, 2, g);
    *out = coloured ? with.link : without.link;
    return status;
}

static iso_status make_squares(iso_multilink *out, int patch) {
    static cylinder c;
    const iso_axis axis[2] = {{4, 1}, {3, 1}};
    static const double g[12] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    iso_square_link link;
    iso_square_patch squares;
    make_cylinder(&c);
    ISO_TRY(patch ? iso_square_link_box(&link, axis, 1, g)
                  : iso_square_link_new(&link, 720, c.alpha, c.beta, 3, c.g));
    *out = link.link;
    if (!patch)
        return ISO_OK;
    iso_status status = iso_square_patch_from_square_link(&squares, &link);
    iso_multilink_free(&link.link);
    *out = squares.link;
    return status;
}

static iso_status make_surface(iso_multilink *out, int kind) {
    static polyhedron s;
    static const double level[4] = {0, 0.25, 0.5, 0.75};
    iso_double_link surface;
    iso_triangulation triangulation;
    iso_coloured_link contours;
    double height[36];
    if (kind == ISO_KIND_COUNT)
        make_prism_box(&s);
    else
        make_tetrahedron(&s);
    ISO_TRY(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED));
    *out = surface.link;
    if (kind == ISO_KIND_DOUBLE_LINK)
        return ISO_OK;
    for (int32_t a = 0; a < surface.link.size; a++)
        height[a] = surface.link.g[3 * a + 2];
    iso_status status = kind == ISO_KIND_TRIANGULATION
                            ? iso_triangulation_from_double_link(&triangulation, &surface)
                            : iso_slice_double_link(&contours, &surface, height, level, 4);
    iso_multilink_free(&surface.link);
    *out = kind == ISO_KIND_TRIANGULATION ? triangulation.link : contours.link;
    return status;
}

static iso_status make_lattice(iso_multilink *out, int cubic) {
    static const iso_axis axis[4] = {{3, 0}, {2, 1}, {4, 0}, {5, 1}};
    int32_t material[24];
    double g[24 * 3];
    iso_cubic_link voxels;
    iso_cube_link cubes;
    for (int32_t a = 0; a < 24; a++) {
        material[a] = a % 3;
        for (int k = 0; k < 3; k++)
            g[3 * a + k] = (k + 1) * a / 7.0;
    }
    iso_status status = cubic ? iso_cubic_link_box(&voxels, axis, 3, g, material)
                              : iso_cube_link_box(&cubes, 4, axis, 0, NULL, NULL);
    *out = cubic ? voxels.link : cubes.link;
    return status;
}

iso_status make_sample(iso_multilink *out, int kind) {
    static const int32_t arc[8] = {2, 4, 0, 6, 1, 7, 3, 5}, line[4] = {0, 0, 1, 1},
                         contour[4] = {0};
    iso_filling_link filling;
    switch (kind) {
    case ISO_KIND_LINK:
    case ISO_KIND_COLOURED_LINK:
        return make_curve(out, kind == ISO_KIND_COLOURED_LINK);
    case ISO_KIND_SQUARE_LINK:
    case ISO_KIND_SQUARE_PATCH:
        return make_squares(out, kind == ISO_KIND_SQUARE_PATCH);
    case ISO_KIND_CUBIC_LINK:
    case ISO_KIND_CUBE_LINK:
        return make_lattice(out, kind == ISO_KIND_CUBIC_LINK);
    case ISO_KIND_FILLING_LINK: {
        iso_status status = iso_filling_link_new(&filling, 4, arc, line, contour);
        *out = filling.link;
        return status;
    }
    default:
        return make_surface(out, kind);
    }
}
