/* What channels are good for: checks, links, files. */
#include "channel/body.h"
#include "mesh/stl_write.h"

// Checks

/* Measured on polygons: a thousandth is what they leave out. */
#define LEEWAY 0.001

static iso_status check_wall(const iso_channel_wall *wall, double least, const char *what) {
    if (wall->thickness >= least * (1 - LEEWAY))
        return ISO_OK;
    if (wall->other < 0)
        return iso_fail(ISO_NOT_VERIFIED,
                        "channel %d leaves %.3f mm of wall %s at (%.2f, %.2f, %.2f); %g are asked "
                        "for",
                        wall->channel + 1, wall->thickness, what, wall->at.x, wall->at.y,
                        wall->at.z, least);
    if (wall->other == wall->channel)
        return iso_fail(ISO_NOT_VERIFIED,
                        "channel %d leaves %.3f mm of wall to itself at (%.2f, %.2f, %.2f); %g are "
                        "asked for",
                        wall->channel + 1, wall->thickness, wall->at.x, wall->at.y, wall->at.z,
                        least);
    return iso_fail(ISO_NOT_VERIFIED,
                    "channels %d and %d leave %.3f mm of wall between them at (%.2f, %.2f, %.2f); "
                    "%g are asked for",
                    wall->channel + 1, wall->other + 1, wall->thickness, wall->at.x, wall->at.y,
                    wall->at.z, least);
}

iso_status iso_channels_check(const iso_channels *channels) {
    const iso_channel_figures *f = &channels->figures;
    double wall = channels->options.wall;
    if (f->bend < channels->bend * (1 - LEEWAY))
        return iso_fail(ISO_NOT_VERIFIED,
                        "channel %d bends by a radius of %.3f mm at (%.2f, %.2f, %.2f); %g are "
                        "asked for",
                        f->bend_channel + 1, f->bend, f->bend_at.x, f->bend_at.y, f->bend_at.z,
                        channels->bend);
    ISO_TRY(check_wall(&f->to_part, wall, "to the part"));
    ISO_TRY(check_wall(&f->between, wall, "between"));
    return check_wall(&f->outside, wall, "to the mould's outside");
}

// Links

iso_status iso_channels_centrelines(iso_coloured_link *out, const iso_channels *channels) {
    int64_t size = 0;
    int32_t *next = NULL, *colour = NULL, at = 0;
    double *g = NULL;
    out->link = (iso_multilink){0};
    for (int32_t i = 0; i < channels->figures.channel_count; i++)
        size += channels->channel[i].line.count;
    if (size > INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "channels of more than 2^31 - 1 points");
    iso_status status = ISO_ALLOCATE(next, size);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(colour, size);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(g, 3 * size);
    for (int32_t i = 0; i < channels->figures.channel_count && status == ISO_OK; i++) {
        const curve *line = &channels->channel[i].line;
        for (int32_t k = 0, first = at; k < line->count; k++, at++) {
            double place[3] = {line->point[k].x, line->point[k].y, line->point[k].z};
            memcpy(g + 3 * (int64_t)at, place, sizeof place);
            next[at] = k + 1 < line->count ? at + 1 : line->closed ? first : at;
            colour[at] = i;
        }
    }
    if (status == ISO_OK)
        status = iso_coloured_link_new(out, (int32_t)size, next, colour, 3, g);
    iso_release(next);
    iso_release(colour);
    iso_release(g);
    return status;
}

static iso_status box_link(iso_square_link *out, const iso_axis axis[2], const iso_vec3 *point) {
    int64_t size = (int64_t)axis[0].length * axis[1].length;
    double *g;
    ISO_TRY(ISO_ALLOCATE(g, 3 * size));
    for (int64_t i = 0; i < size; i++) {
        double place[3] = {point[i].x, point[i].y, point[i].z};
        memcpy(g + 3 * i, place, sizeof place);
    }
    iso_status status = iso_square_link_box(out, axis, 3, g);
    iso_release(g);
    return status;
}

static iso_status check_number(int32_t number, int32_t count, const char *what) {
    if (number >= 0 && number < count)
        return ISO_OK;
    return iso_fail(ISO_USAGE, "there is no %s %d; there are %d", what, number, count);
}

iso_status iso_channels_skin(iso_square_link *out, const iso_channels *channels, int32_t number) {
    out->link = (iso_multilink){0};
    ISO_TRY(check_number(number, channels->figures.channel_count, "channel"));
    const skin *s = &channels->channel[number].skin;
    iso_axis axis[2] = {{s->sides, 1}, {s->rows, s->closed}};
    return box_link(out, axis, s->point);
}

iso_status iso_channels_tower(iso_square_link *out, double **height, const iso_channels *channels,
                              int32_t number) {
    out->link = (iso_multilink){0};
    ISO_TRY(check_number(number, channels->tower_count, "tower"));
    const tower *t = &channels->tower[number];
    iso_axis axis[2] = {{t->samples, 1}, {t->rings, 0}};
    size_t size = (size_t)t->samples * (size_t)t->rings;
    ISO_TRY(box_link(out, axis, t->g));
    if (!height)
        return ISO_OK;
    iso_status status = ISO_ALLOCATE(*height, size);
    if (status == ISO_OK)
        memcpy(*height, t->f, size * sizeof **height);
    else
        iso_multilink_free(&out->link);
    return status;
}

void iso_channels_release(void *block) {
    iso_release(block);
}

// Files

/* What is lost by rounding to the floats of a file: parts of a million, on walls of 1 mm. */
#define VOLUME_LEEWAY 1e-4

static iso_status read_back(const float *triangle, int64_t count, double volume) {
    iso_mesh mesh;
    ISO_TRY(iso_mesh_from_triangles(&mesh, triangle, count));
    const iso_mesh_defects *d = &mesh.defects;
    int64_t mended = d->degenerate + d->duplicate + d->cancelled + d->bad_edges +
                     d->flipped_triangles + d->inverted_shells + d->holes_closed;
    double found = iso_mesh_volume(&mesh);
    iso_mesh_free(&mesh);
    if (mended > 0)
        return iso_fail(ISO_NOT_VERIFIED,
                        "read back, the mesh has %lld defects: channels, part "
                        "and the mould's sides touch each other, or the part "
                        "itself had them",
                        (long long)mended);
    if (!(fabs(found - volume) <= VOLUME_LEEWAY * fabs(volume)))
        return iso_fail(ISO_NOT_VERIFIED, "read back, the mesh has %.6g mm3, not %.6g", found,
                        volume);
    return ISO_OK;
}

iso_status iso_channels_triangles(float **triangle, int64_t *count, const iso_channels *channels,
                                  iso_channel_output output) {
    const iso_channel_figures *f = &channels->figures;
    double volume;
    ISO_TRY(channels_mesh(triangle, count, &volume, channels, output));
    iso_status status =
        read_back(*triangle, *count, output == ISO_CHANNEL_MOULD ? f->mould_volume : f->volume);
    if (status != ISO_OK) {
        iso_release(*triangle);
        *triangle = NULL;
        *count = 0;
    }
    return status;
}

iso_status iso_channels_write_stl(int64_t *triangles, const iso_channels *channels,
                                  iso_channel_output output, const char *path) {
    float *triangle;
    ISO_TRY(iso_channels_triangles(&triangle, triangles, channels, output));
    iso_status status = stl_write(path,
                                  output == ISO_CHANNEL_MOULD ? "mould, made by isoslice"
                                                              : "channels, made by isoslice",
                                  triangle, *triangles);
    iso_release(triangle);
    return status;
}
