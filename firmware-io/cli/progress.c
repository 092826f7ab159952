#include "progress.h"

#include <math.h>

void fio_progress_begin(fio_progress *progress, const fio_source_summary *whole) {
    *progress = (fio_progress){
        .whole = *whole, .last = -1, .from = -1, .minutes = -1, .share = -1, .seconds_left = -1};
}

/* What M73 says is the slicer's own reckoning; bytes are the next best measure. */
static double share_of(const fio_progress *progress, const fio_stream_report *report) {
    if (report->percent >= 0)
        return fmin(report->percent, 100) / 100;
    if (progress->whole.bytes > 0)
        return fmin((double)report->offset / (double)progress->whole.bytes, 1);
    return -1;
}

/* From the slicer's estimate at first, and more and more from how long the part behind us took. */
static double reckon(const fio_progress *progress) {
    double whole = progress->whole.seconds, share = progress->share;
    double done = share - progress->from;
    if (share < 0 || progress->from < 0)
        return share >= 0 && whole > 0 ? (1 - share) * whole : -1;
    if (whole > 0) {
        double seen = done > 0.01 ? progress->active / done : whole;
        return (1 - share) * ((1 - done) * whole + done * seen);
    }
    return done > 0.02 && progress->active > 10 ? (1 - share) * progress->active / done : -1;
}

void fio_progress_update(fio_progress *progress, const fio_stream_report *report, double now) {
    bool printing = report->state == FIO_STREAM_RUNNING || report->state == FIO_STREAM_FINISHING;
    double passed = progress->last >= 0 && printing ? fmax(now - progress->last, 0) : 0;
    progress->last = now;
    progress->share = share_of(progress, report);
    /* Heating up tells nothing of how fast the printer prints. */
    bool begun = report->accepted > 0 && (report->layer > 0 || progress->whole.layers <= 0);
    if (progress->from >= 0)
        progress->active += passed;
    else if (begun)
        progress->from = fmax(progress->share, 0);
    if (report->minutes_left < 0) {
        progress->seconds_left = reckon(progress);
        return;
    }
    if (progress->minutes != report->minutes_left) {
        progress->minutes = report->minutes_left;
        progress->minutes_at = progress->active;
    }
    progress->seconds_left =
        fmax(progress->minutes * 60.0 - (progress->active - progress->minutes_at), 0);
}

void fio_progress_duration(fio_text *text, double seconds) {
    int64_t whole = (int64_t)fmin(fmax(seconds, 0) + 0.5, 1e9);
    if (whole < 60) {
        fio_text_integer(text, whole);
        fio_text_string(text, " s");
        return;
    }
    if (whole >= 3600) {
        fio_text_integer(text, whole / 3600);
        fio_text_string(text, whole / 60 % 60 < 10 ? " h 0" : " h ");
    }
    fio_text_integer(text, whole / 60 % 60);
    fio_text_string(text, " min");
}

static void temperature(fio_text *text, const char *what, double actual, double target) {
    fio_text_string(text, what);
    fio_text_number(text, actual, 0);
    fio_text_string(text, "/");
    fio_text_number(text, target, 0);
    fio_text_string(text, " C");
}

static void place(fio_text *text, const fio_progress *progress, const fio_stream_report *report) {
    if (progress->share >= 0) {
        fio_text_integer(text, (int64_t)(progress->share * 100 + 1e-9));
        fio_text_string(text, " %");
    } else {
        fio_text_string(text, "line ");
        fio_text_integer(text, report->line);
    }
    if (report->layer > 0) {
        fio_text_string(text, ", layer ");
        fio_text_integer(text, report->layer);
    }
    if (report->layer > 0 && progress->whole.layers > 0) {
        fio_text_string(text, "/");
        fio_text_integer(text, progress->whole.layers);
    }
    if (progress->seconds_left >= 0 && report->state != FIO_STREAM_DONE) {
        fio_text_string(text, ", ");
        fio_progress_duration(text, progress->seconds_left);
        fio_text_string(text, " left");
    }
}

void fio_progress_describe(fio_text *text, const fio_progress *progress,
                           const fio_stream_report *report) {
    place(text, progress, report);
    if (report->has_temperatures)
        temperature(text, ", nozzle ", report->nozzle, report->nozzle_target);
    if (report->has_bed)
        temperature(text, ", bed ", report->bed, report->bed_target);
}

const char *fio_progress_state_name(fio_stream_state state) {
    static const char *const name[FIO_STREAM_STATES] = {
        [FIO_STREAM_GREETING] = "connecting",   [FIO_STREAM_RUNNING] = "printing",
        [FIO_STREAM_PAUSING] = "pausing",       [FIO_STREAM_PAUSED] = "paused",
        [FIO_STREAM_RESUMING] = "resuming",     [FIO_STREAM_FINISHING] = "finishing",
        [FIO_STREAM_CANCELLING] = "cancelling", [FIO_STREAM_DONE] = "done",
    };
    return (unsigned)state < FIO_STREAM_STATES ? name[state] : "";
}
