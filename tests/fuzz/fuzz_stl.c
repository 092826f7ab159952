/* Bytes as an STL file: what is read is a sound double-link, and its slices are a sound link. */
#include "fuzz.h"

#include <isoslice/mesh.h>
#include <isoslice/slice.h>

#include "mesh/stl.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    iso_mesh mesh = {0};
    if (iso_mesh_read_memory(&mesh, bytes, (int64_t)size) != ISO_OK)
        return 0;
    fuzz_right(iso_mesh_validate(&mesh));
    iso_levels levels = {0};
    iso_slices slices = {0};
    double height = mesh.max.z - mesh.min.z;
    iso_mesh_translate(&mesh, (iso_vec3){0, 0, -mesh.min.z});
    if (height > 0 && iso_levels_uniform(&levels, height, height / 7, height / 7) == ISO_OK &&
        iso_slice_planar(&slices, &mesh, &levels) == ISO_OK)
        fuzz_right(iso_slices_validate(&slices));
    iso_slices_free(&slices);
    iso_levels_free(&levels);
    iso_mesh_free(&mesh);
    return 0;
}
