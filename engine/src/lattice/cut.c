#include "lattice/cut.h"

#include <math.h>

static int32_t voxel_of(double at, double min, double voxel) {
    double i = floor((at - min) / voxel + 0.5);
    return i > 2e9 ? 2000000000 : i > -2e9 ? (int32_t)i : -2000000000;
}

/* Does the run end before the voxel? */
static int is_before(const iso_lattice_run *run, const int32_t at[3]) {
    if (run->z != at[2])
        return run->z < at[2];
    if (run->y != at[1])
        return run->y < at[1];
    return run->end <= at[0];
}

static void find_voxel(int32_t voxel[3], const iso_lattice_cut *cut, iso_vec3 at) {
    voxel[0] = voxel_of(at.x, cut->min.x, cut->voxel);
    voxel[1] = voxel_of(at.y, cut->min.y, cut->voxel);
    voxel[2] = voxel_of(at.z, cut->min.z, cut->voxel);
}

int64_t cut_find(const iso_lattice_cut *cut, iso_vec3 at) {
    int32_t voxel[3];
    int64_t low = 0, high = cut->count;
    find_voxel(voxel, cut, at);
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (is_before(&cut->run[middle], voxel))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

int cut_meets(const iso_lattice_cut *cut, int64_t run, iso_vec3 at) {
    int32_t voxel[3];
    if (run >= cut->count)
        return 0;
    const iso_lattice_run *r = &cut->run[run];
    find_voxel(voxel, cut, at);
    return r->z == voxel[2] && r->y == voxel[1] && r->first <= voxel[0] && voxel[0] < r->end;
}

int cut_is_before(const iso_lattice_cut *cut, int64_t run, iso_vec3 at) {
    int32_t voxel[3];
    find_voxel(voxel, cut, at);
    return is_before(&cut->run[run], voxel);
}
