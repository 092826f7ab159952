#include "config/spelling.h"

#include <string.h>

static int smaller(int a, int b) {
    return a < b ? a : b;
}

static char letter(char c) {
    return c == '-' ? '_' : c;
}

bool iso_same_key(const char *known, const char *given) {
    for (; *known; known++, given++)
        if (*known != letter(*given))
            return false;
    return *given == 0;
}

int iso_edit_distance(const char *known, const char *given) {
    int row[ISO_SPELLING_MAX + 1];
    int n = (int)strlen(given);
    if (n > ISO_SPELLING_MAX)
        return ISO_SPELLING_MAX;
    for (int j = 0; j <= n; j++)
        row[j] = j;
    for (int i = 0; known[i]; i++) {
        int corner = row[0];
        row[0] = i + 1;
        for (int j = 0; j < n; j++) {
            int changed = corner + (letter(known[i]) != letter(given[j]));
            corner = row[j + 1];
            row[j + 1] = smaller(changed, 1 + smaller(row[j], corner));
        }
    }
    return row[n];
}

int iso_edit_tolerance(const char *given) {
    return smaller(3, (int)strlen(given) / 3);
}
