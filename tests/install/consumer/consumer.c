#include <stdio.h>

#include <isoslice/isoslice.h>

int bytes_of_a_job(const char *model, const char *output); /* in C++ */

int main(int argc, char **argv) {
    iso_bead bead = iso_bead_of(iso_units(0.45), iso_units(0.2));
    printf("isoslice: a bead of %g x %g mm; %s\n", iso_mm(bead.width), iso_mm(bead.height),
           iso_role_name(ISO_ROLE_PERIMETER));
    return bead.area <= 0 || argc < 3 || bytes_of_a_job(argv[1], argv[2]) < 10000;
}
