/* What the numpy scripts run:
 *     link-tool samples DIRECTORY               one file of each kind
 *     link-tool slice INPUT SURFACE CONTOURS    faces and heights become a double-link and its
 * slice INPUT is int32 dimension, faces, vertices, levels, fans; int32 first[faces + 1],
 * vertex[...]; float64 position[vertices * dimension], height[vertices], level[levels]. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <isoslice/link.h>

#include "link/samples.h"

static iso_status write_samples(const char *directory) {
    for (int kind = 0; kind < SAMPLE_COUNT; kind++) {
        char path[1024];
        iso_multilink link;
        snprintf(path, sizeof path, "%s/%s.mlk", directory, sample_name(kind));
        ISO_TRY(make_sample(&link, kind));
        iso_status status = iso_multilink_write(path, &link, ISO_LINK_FLOAT64);
        if (status == ISO_OK && kind == ISO_KIND_SQUARE_LINK) {
            snprintf(path, sizeof path, "%s/%s32.mlk", directory, sample_name(kind));
            status = iso_multilink_write(path, &link, ISO_LINK_FLOAT32);
        }
        iso_multilink_free(&link);
        ISO_TRY(status);
    }
    return ISO_OK;
}

typedef struct input {
    int32_t count[5]; /* dimension, faces, vertices, levels, fans */
    int32_t *first, *vertex;
    double *position, *height, *level;
} input;

static void *take(FILE *file, size_t count, size_t size) {
    void *block = malloc(count * size + 1);
    if (!block || fread(block, size, count, file) != count)
        exit(2);
    return block;
}

static input read_input(const char *path) {
    input in;
    FILE *file = fopen(path, "rb");
    if (!file || fread(in.count, sizeof in.count, 1, file) != 1)
        exit(2);
    in.first = take(file, (size_t)in.count[1] + 1, 4);
    in.vertex = take(file, (size_t)in.first[in.count[1]], 4);
    in.position = take(file, (size_t)in.count[2] * (size_t)in.count[0], 8);
    in.height = take(file, (size_t)in.count[2], 8);
    in.level = take(file, (size_t)in.count[3], 8);
    fclose(file);
    return in;
}

static iso_status slice(const input *in, char **path) {
    iso_faces faces = {in->count[1], in->count[2], in->first,
                       in->vertex,   in->count[0], in->position};
    iso_double_link surface;
    iso_coloured_link contours = {0};
    ISO_TRY(iso_double_link_from_faces(&surface, &faces, (iso_boundary)in->count[4]));
    iso_status status = iso_multilink_write(path[0], &surface.link, ISO_LINK_FLOAT64);
    double *height = malloc((size_t)surface.link.size * sizeof *height + 1);
    for (int32_t a = 0; a < surface.link.size; a++) {
        int32_t v = iso_double_link_vertex(&surface, a);
        height[a] = v < in->count[2] ? in->height[v] : 0.5; /* a fan's middle */
    }
    if (status == ISO_OK)
        status = iso_slice_double_link(&contours, &surface, height, in->level, in->count[3]);
    if (status == ISO_OK)
        status = iso_multilink_write(path[1], &contours.link, ISO_LINK_FLOAT64);
    iso_multilink_free(&contours.link);
    iso_multilink_free(&surface.link);
    free(height);
    return status;
}

int main(int count, char **argument) {
    iso_status status = ISO_USAGE;
    if (count == 3 && strcmp(argument[1], "samples") == 0)
        status = write_samples(argument[2]);
    if (count == 5 && strcmp(argument[1], "slice") == 0) {
        input in = read_input(argument[2]);
        status = slice(&in, argument + 3);
        free(in.first);
        free(in.vertex);
        free(in.position);
        free(in.height);
        free(in.level);
    }
    if (status != ISO_OK)
        fprintf(stderr, "link-tool: %s\n", iso_error_message());
    return (int)status;
}
