/* isoslice info: what a model is, and what is wrong with it. */
#include <isoslice/mesh.h>

#include <stdio.h>

#include "config/json.h"
#include "verbs.h"

static void print_defects(const iso_mesh_defects *defects) {
    const struct {
        const char *what;
        int64_t count;
    } list[] = {{"degenerate triangles, dropped", defects->degenerate},
                {"duplicate triangles, dropped", defects->duplicate},
                {"coincident faces, dropped", defects->cancelled},
                {"edges without one partner", defects->bad_edges},
                {"vertices welded within 10 um", defects->welded_vertices},
                {"triangles turned over", defects->flipped_triangles},
                {"shells turned inside out", defects->inverted_shells},
                {"holes closed", defects->holes_closed}};
    bool sound = true;
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        if (list[i].count == 0)
            continue;
        printf("  %-10s %lld %s\n", sound ? "defects" : "", (long long)list[i].count, list[i].what);
        sound = false;
    }
    if (sound)
        printf("  defects    none\n");
}

static void print_model(const char *path, const iso_mesh *mesh) {
    iso_vec3 low = mesh->min, high = mesh->max;
    printf("%s\n", path);
    printf("  triangles  %d\n", mesh->triangle_count);
    printf("  vertices   %d\n", mesh->vertex_count);
    printf("  shells     %lld\n", (long long)mesh->defects.shells);
    printf("  size       %.3f x %.3f x %.3f mm\n", high.x - low.x, high.y - low.y, high.z - low.z);
    printf("  from       %.3f, %.3f, %.3f mm\n", low.x, low.y, low.z);
    printf("  volume     %.3f mm3\n", iso_mesh_volume(mesh));
    print_defects(&mesh->defects);
}

static void write_point(iso_json *json, const char *name, iso_vec3 p) {
    iso_json_begin(json, name, '[');
    iso_json_number(json, NULL, p.x);
    iso_json_number(json, NULL, p.y);
    iso_json_number(json, NULL, p.z);
    iso_json_end(json, ']');
}

static void write_model(iso_json *json, const char *path, const iso_mesh *mesh) {
    iso_vec3 low = mesh->min, high = mesh->max;
    iso_json_begin(json, NULL, '{');
    iso_json_text(json, "file", path);
    iso_json_integer(json, "triangles", mesh->triangle_count);
    iso_json_integer(json, "vertices", mesh->vertex_count);
    iso_json_integer(json, "shells", mesh->defects.shells);
    write_point(json, "size", (iso_vec3){high.x - low.x, high.y - low.y, high.z - low.z});
    write_point(json, "min", low);
    write_point(json, "max", high);
    iso_json_number(json, "volume", iso_mesh_volume(mesh));
    iso_json_defects(json, &mesh->defects);
    iso_json_end(json, '}');
}

/* A list of all models, or nothing at all. */
static iso_status write_models(const iso_arguments *arguments) {
    iso_output *output;
    ISO_TRY(iso_output_open(&output, "-"));
    iso_json json = {.output = output};
    iso_json_begin(&json, NULL, '[');
    for (int32_t i = 0; i < arguments->file_count; i++) {
        iso_mesh mesh;
        iso_status status = iso_mesh_read(&mesh, arguments->file[i]);
        if (status != ISO_OK) {
            iso_output_abandon(output);
            return status;
        }
        write_model(&json, arguments->file[i], &mesh);
        iso_mesh_free(&mesh);
    }
    iso_json_end(&json, ']');
    return iso_output_commit(output);
}

iso_status iso_verb_info(const iso_arguments *arguments) {
    if (arguments->file_count == 0)
        return iso_fail(ISO_USAGE, "no model given; see isoslice info --help");
    if (arguments->json)
        return write_models(arguments);
    for (int32_t i = 0; i < arguments->file_count; i++) {
        iso_mesh mesh;
        ISO_TRY(iso_mesh_read(&mesh, arguments->file[i]));
        if (!arguments->quiet)
            print_model(arguments->file[i], &mesh);
        iso_mesh_free(&mesh);
    }
    return ISO_OK;
}
