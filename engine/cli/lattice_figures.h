/* What a lattice is like, in words and as JSON. */
#ifndef ISO_CLI_LATTICE_FIGURES_H
#define ISO_CLI_LATTICE_FIGURES_H

#include <stdio.h>

#include <isoslice/porous.h>

#include "config/json.h"

void iso_lattice_print(FILE *file, const char *output, const iso_porous_figures *figures);

#endif
