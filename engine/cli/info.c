/* isoslice info: what a model is, and what is wrong with it. */
#include <isoslice/mesh.h>

#include <stdio.h>

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

iso_status iso_verb_info(const iso_arguments *arguments) {
    if (arguments->file_count == 0)
        return iso_fail(ISO_USAGE, "no model given; see isoslice info --help");
    for (int32_t i = 0; i < arguments->file_count; i++) {
        iso_mesh mesh;
        ISO_TRY(iso_mesh_read(&mesh, arguments->file[i]));
        if (!arguments->quiet)
            print_model(arguments->file[i], &mesh);
        iso_mesh_free(&mesh);
    }
    return ISO_OK;
}
