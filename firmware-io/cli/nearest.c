#include "nearest.h"

#include <string.h>

enum { LONGEST = 63 };

static int smaller(int a, int b) {
    return a < b ? a : b;
}

static char letter(char c) {
    return c == '-' ? '_' : c;
}

/* Levenshtein's distance, row by row. */
int fio_nearest_distance(const char *known, const char *given) {
    int row[LONGEST + 1];
    size_t columns = strlen(given);
    if (columns > LONGEST)
        return LONGEST;
    for (size_t j = 0; j <= columns; j++)
        row[j] = (int)j;
    for (int i = 0; known[i]; i++) {
        int diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < columns; j++) {
            int changed = diagonal + (letter(known[i]) != letter(given[j]));
            diagonal = row[j + 1];
            row[j + 1] = smaller(changed, 1 + smaller(row[j], diagonal));
        }
    }
    return row[columns];
}

int fio_nearest_tolerance(const char *given) {
    return smaller(3, ((int)strlen(given) + 2) / 3);
}
