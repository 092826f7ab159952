/* Triangles of channels, and of a mould with channels and part taken out of it. */
#include "channel/body.h"
#include "channel/opening.h"

typedef struct soup {
    float *triangle;
    int64_t count, capacity; /* triangles; floats there is room for */
} soup;

static iso_status add(soup *s, iso_vec3 a, iso_vec3 b, iso_vec3 c) {
    float nine[9] = {(float)a.x, (float)a.y, (float)a.z, (float)b.x, (float)b.y,
                     (float)b.z, (float)c.x, (float)c.y, (float)c.z};
    ISO_TRY(ISO_GROW(s->triangle, s->capacity, 9 * (s->count + 1)));
    memcpy(s->triangle + 9 * s->count++, nine, sizeof nine);
    return ISO_OK;
}

/* Seen from outside of the channel, or from within it. */
static iso_status add_facing(soup *s, iso_vec3 a, iso_vec3 b, iso_vec3 c, bool inwards) {
    return inwards ? add(s, a, c, b) : add(s, a, b, c);
}

static iso_status add_skin(soup *s, const skin *from, bool inwards) {
    for (int32_t r = 0; r < skin_steps(from); r++)
        for (int32_t k = 0; k < from->sides; k++) {
            iso_vec3 c[6];
            skin_square(c, from, r, k);
            ISO_TRY(add_facing(s, c[0], c[1], c[2], inwards));
            ISO_TRY(add_facing(s, c[3], c[4], c[5], inwards));
        }
    return ISO_OK;
}

/* Both ends of an open channel: sections are convex. */
static iso_status add_caps(soup *s, const skin *from) {
    const iso_vec3 *a = from->point, *b = a + (int64_t)from->sides * (from->rows - 1);
    for (int32_t k = 1; k + 1 < from->sides; k++) {
        ISO_TRY(add(s, a[0], a[k + 1], a[k]));
        ISO_TRY(add(s, b[0], b[k], b[k + 1]));
    }
    return ISO_OK;
}

// The side that ports are on

/* Of the kernel, x along the side and y up: along x z = out, so it is seen from outside. */
static iso_point to_side(const port_side *side, iso_vec3 p) {
    return (iso_point){iso_units(vec3_dot(p, side->along)), iso_units(p.z)};
}

static iso_vec3 from_side(const port_side *side, iso_point p) {
    double along = iso_mm(p.x);
    if (side->axis == 0)
        return vec3(side->out.x * side->face, side->along.y * along, iso_mm(p.y));
    return vec3(side->along.x * along, side->out.y * side->face, iso_mm(p.y));
}

static iso_status add_opening(iso_region *raw, const port_side *side, const skin *s, int32_t row) {
    iso_point point[ISO_SECTION_SIDES_MAX];
    for (int32_t k = 0; k < s->sides; k++)
        point[k] = to_side(side, s->point[(int64_t)s->sides * row + k]);
    return iso_region_add(raw, point, s->sides);
}

static iso_status list_side(iso_region *raw, const iso_channels *c) {
    iso_point low = to_side(&c->side, c->figures.box_min);
    iso_point high = to_side(&c->side, c->figures.box_max);
    iso_box box = {{low.x < high.x ? low.x : high.x, low.y},
                   {low.x < high.x ? high.x : low.x, high.y}};
    iso_point corner[4] = {box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}};
    if (box.min.x < -ISO_COORDINATE_MAX || box.max.x > ISO_COORDINATE_MAX ||
        box.min.y < -ISO_COORDINATE_MAX || box.max.y > ISO_COORDINATE_MAX)
        return iso_fail(ISO_OUTSIDE, "the mould's side is farther than %g mm from the origin",
                        iso_mm(ISO_COORDINATE_MAX));
    ISO_TRY(iso_region_add(raw, corner, 4));
    for (int32_t i = 0; i < c->figures.channel_count; i++) {
        const skin *s = &c->channel[i].skin;
        if (s->closed)
            continue;
        ISO_TRY(add_opening(raw, &c->side, s, 0));
        ISO_TRY(add_opening(raw, &c->side, s, s->rows - 1));
    }
    return ISO_OK;
}

static iso_status add_port_side(soup *s, const iso_channels *c) {
    iso_region raw = {0};
    iso_point *corner = NULL;
    int64_t count = 0;
    iso_status status = list_side(&raw, c);
    if (status == ISO_OK)
        status = side_with_openings(&corner, &count, &raw);
    for (int64_t t = 0; t < count && status == ISO_OK; t++)
        status = add(s, from_side(&c->side, corner[3 * t]), from_side(&c->side, corner[3 * t + 1]),
                     from_side(&c->side, corner[3 * t + 2]));
    iso_release(corner);
    iso_region_free(&raw);
    return status;
}

// The block

static iso_vec3 box_corner(const iso_channel_figures *f, int i) {
    return vec3(i & 1 ? f->box_max.x : f->box_min.x, i & 2 ? f->box_max.y : f->box_min.y,
                i & 4 ? f->box_max.z : f->box_min.z);
}

static iso_status add_block(soup *s, const iso_channels *c) {
    /* by iso_channel_side, then below and above; counter-clockwise from outside */
    static const int quad[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int i = 0; i < 6; i++) {
        iso_vec3 at[4];
        if (i == (int)c->options.side) {
            ISO_TRY(add_port_side(s, c));
            continue;
        }
        for (int k = 0; k < 4; k++)
            at[k] = box_corner(&c->figures, quad[i][k]);
        ISO_TRY(add(s, at[0], at[1], at[2]));
        ISO_TRY(add(s, at[0], at[2], at[3]));
    }
    return ISO_OK;
}

static iso_status add_part(soup *s, const iso_mesh *mesh) {
    for (int64_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->origin + 3 * t;
        ISO_TRY(add(s, mesh->position[v[0]], mesh->position[v[2]], mesh->position[v[1]]));
    }
    return ISO_OK;
}

static iso_status list_triangles(soup *s, const iso_channels *c, bool mould) {
    if (mould) {
        ISO_TRY(add_block(s, c));
        ISO_TRY(add_part(s, c->mesh));
    }
    for (int32_t i = 0; i < c->figures.channel_count; i++) {
        const skin *from = &c->channel[i].skin;
        ISO_TRY(add_skin(s, from, mould));
        if (!from->closed && !mould)
            ISO_TRY(add_caps(s, from));
    }
    return ISO_OK;
}

static double volume_of(const soup *s) {
    double six = 0;
    for (int64_t t = 0; t < s->count; t++) {
        const float *p = s->triangle + 9 * t;
        six += vec3_dot(vec3(p[0], p[1], p[2]),
                        vec3_cross(vec3(p[3], p[4], p[5]), vec3(p[6], p[7], p[8])));
    }
    return six / 6;
}

iso_status channels_mesh(float **triangle, int64_t *count, double *volume, const iso_channels *c,
                         iso_channel_output output) {
    soup s = {0};
    *triangle = NULL;
    *count = 0;
    iso_status status = list_triangles(&s, c, output == ISO_CHANNEL_MOULD);
    if (status != ISO_OK) {
        iso_release(s.triangle);
        return status;
    }
    *triangle = s.triangle;
    *count = s.count;
    *volume = volume_of(&s);
    return ISO_OK;
}
