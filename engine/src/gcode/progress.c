#include "gcode/progress.h"

#include <string.h>

#include "base/memory.h"
#include "gcode/number.h"

enum { LINE_SIZE = sizeof "M73 P100 R99999" /* its newline in the terminator's place */ };

void iso_progress_free(iso_progress *progress) {
    iso_release(progress->point);
    *progress = (iso_progress){0};
}

iso_status iso_progress_mark(iso_progress *progress, int64_t offset, double time) {
    ISO_TRY(ISO_GROW(progress->point, progress->capacity, progress->count + 1));
    progress->point[progress->count++] = (iso_progress_point){offset, time};
    return ISO_OK;
}

char *iso_progress_put_line(char *to, int percent, int64_t minutes) {
    char *end = to + LINE_SIZE;
    memset(to, ' ', LINE_SIZE);
    to[LINE_SIZE - 1] = '\n';
    memcpy(to, "M73 P", 5);
    to = iso_put_integer(to + 5, percent);
    memcpy(to, " R", 2);
    iso_put_integer(to + 2, minutes < 99999 ? minutes : 99999);
    return end;
}

iso_status iso_progress_fill_in(iso_output *output, const iso_progress *progress,
                                double whole_time) {
    for (int64_t i = 0; i < progress->count; i++) {
        double time = progress->point[i].time < whole_time ? progress->point[i].time : whole_time;
        int percent = whole_time > 0 ? (int)(100 * time / whole_time) : 0;
        char line[LINE_SIZE];
        iso_progress_put_line(line, percent, (int64_t)((whole_time - time) / 60 + 0.5));
        ISO_TRY(iso_output_patch(output, progress->point[i].offset, line, LINE_SIZE));
    }
    return ISO_OK;
}
