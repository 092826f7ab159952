#include "progress.h"

#include <stdio.h>
#include <time.h>

static double clock_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

void iso_progress_draw(void *payload, double done, const char *stage) {
    iso_progress *line = payload;
    double now = clock_seconds();
    if (line->shown && now - line->drawn < 0.05)
        return;
    fprintf(stderr, "\r\033[K%3.0f%% %s", done * 100, stage);
    line->drawn = now;
    line->shown = true;
}

void iso_progress_clear(const iso_progress *line) {
    if (line->shown)
        fprintf(stderr, "\r\033[K");
}
