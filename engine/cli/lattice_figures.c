#include "lattice_figures.h"

static void print_pieces(FILE *file, const iso_porous_figures *f) {
    if (f->removed > 0)
        fprintf(file, "  pieces     %lld that hold to nothing removed, %.4g mm3\n",
                (long long)f->removed, f->removed_volume);
    if (f->left > 0)
        fprintf(file, "  pieces     %lld that hold to nothing left\n", (long long)f->left);
    if (f->removed == 0 && f->left == 0)
        fprintf(file, "  pieces     none that holds to nothing\n");
    if (f->closed_pores > 0)
        fprintf(file, "  closed     %lld pores, %.4g mm3\n", (long long)f->closed_pores,
                f->closed_volume);
    else
        fprintf(file, "  closed     no pore\n");
}

void iso_lattice_print(FILE *file, const char *output, const iso_porous_figures *f) {
    fprintf(file, "%s\n", output);
    fprintf(file, "  porosity   %.2f %%", f->porosity * 100);
    if (f->asked_porosity >= 0)
        fprintf(file, " (asked: %.2f %%)", f->asked_porosity * 100);
    if (f->core_volume < f->part_volume)
        fprintf(file, "; with its skin %.2f %%", f->part_porosity * 100);
    fprintf(file, "\n  volume     %.1f of %.1f mm3, %.3g cells of %.4g mm\n", f->volume,
            f->part_volume, f->cells, f->cell);
    fprintf(file, "  surface    %.1f mm2, %.3f mm2/mm3 of it in pores\n", f->surface,
            f->part_volume > 0 ? f->pore_surface / f->part_volume : 0);
    if (f->detail > 0) {
        fprintf(file, "  pores      %.3f mm wide, at most %.3f; d10 %.3f, d50 %.3f, d90 %.3f\n",
                f->pore_mean, f->pore_largest, f->pore_d10, f->pore_d50, f->pore_d90);
        fprintf(file, "  walls      %.3f mm thick, at least %.3f\n", f->wall_mean,
                f->wall_smallest);
    }
    print_pieces(file, f);
    fprintf(file, "  voxels     %.4g mm\n", f->voxel);
}
