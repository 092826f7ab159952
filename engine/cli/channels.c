/* isoslice channels: cooling channels around a part, or a mould of the part that has them. */
#include <isoslice/channel.h>

#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/resource.h>
#include <time.h>

#include "channel_picture.h"
#include "progress.h"
#include "verbs.h"

typedef enum output { OUTPUT_CHANNELS, OUTPUT_MOULD, OUTPUT_LINK, OUTPUT_PICTURE } output;

typedef struct work {
    const iso_arguments *arguments;
    const char *path;
    output output;
    iso_report report;
    iso_channel_options options;
    iso_progress line;
    iso_mesh mesh;
    iso_channels *channels;
    double begun;
} work;

static double clock_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

// What is asked for

static bool is_named_mould(const char *path) {
    const char *base = strrchr(path, '/');
    for (const char *c = base ? base + 1 : path; *c; c++)
        if (strncasecmp(c, "mould", 5) == 0 || strncasecmp(c, "mold", 4) == 0)
            return true;
    return false;
}

static iso_status find_output(output *found, const char *path, const char *write) {
    if (iso_ends_in(path, ".mlk") || iso_ends_in(path, ".svg")) {
        *found = iso_ends_in(path, ".mlk") ? OUTPUT_LINK : OUTPUT_PICTURE;
        return write ? iso_fail(ISO_USAGE, "--write %.60s: %s isn't an .stl", write, path) : ISO_OK;
    }
    if (!iso_ends_in(path, ".stl") && strcmp(path, "-") != 0)
        return iso_fail(ISO_USAGE, "%s: channels are written as .stl, .mlk or .svg", path);
    *found = is_named_mould(path) ? OUTPUT_MOULD : OUTPUT_CHANNELS;
    if (!write)
        return ISO_OK;
    bool mould = strcmp(write, "mould") == 0 || strcmp(write, "mold") == 0;
    if (!mould && strcmp(write, "channels") != 0)
        return iso_fail(ISO_USAGE, "--write %.60s: one of channels, mould is due", write);
    *found = mould ? OUTPUT_MOULD : OUTPUT_CHANNELS;
    return ISO_OK;
}

static iso_status choose(work *w) {
    const iso_arguments *arguments = w->arguments;
    ISO_TRY(find_output(&w->output, w->path, arguments->write));
    if (arguments->report && strcmp(arguments->report, w->path) == 0)
        return iso_fail(ISO_USAGE, "%s: can't hold both the result and the report", w->path);
    ISO_TRY(iso_keep_files(arguments, w->path));
    ISO_TRY(iso_keep_files(arguments, arguments->report));
    w->options = arguments->channels;
    ISO_TRY(iso_channel_section_parse(&w->options.section,
                                      arguments->section ? arguments->section : "round:8",
                                      arguments->sides));
    if (arguments->progress && !arguments->quiet) {
        w->options.progress = iso_progress_draw;
        w->options.payload = &w->line;
    }
    return ISO_OK;
}

// What comes out

static iso_status write_link(const work *w) {
    iso_coloured_link link;
    ISO_TRY(iso_channels_centrelines(&link, w->channels));
    iso_status status = iso_multilink_write(w->path, &link.link, ISO_LINK_FLOAT64);
    iso_multilink_free(&link.link);
    return status;
}

static iso_status write_result(work *w) {
    switch (w->output) {
    case OUTPUT_LINK:
        return write_link(w);
    case OUTPUT_PICTURE:
        return iso_channel_picture(w->path, w->channels);
    default:
        return iso_channels_write_stl(
            &w->report.channel_triangles, w->channels,
            w->output == OUTPUT_MOULD ? ISO_CHANNEL_MOULD : ISO_CHANNEL_SKINS, w->path);
    }
}

static iso_status warn(work *w) {
    const iso_channel_figures *f = w->report.channels;
    if (f->incomplete > 0)
        ISO_TRY(iso_report_warn(&w->report, "channel-incomplete",
                                "on %d towers a level leaves the surface before it is around, and "
                                "has no channel",
                                f->incomplete));
    if (f->narrow > 0)
        ISO_TRY(iso_report_warn(&w->report, "channel-narrow",
                                "on %d tops the last ring would be too narrow to bend, and is left "
                                "out",
                                f->narrow));
    if (f->folds > 0)
        ISO_TRY(iso_report_warn(&w->report, "channel-folds",
                                "at %d places channels are cut short, for the part bends more "
                                "narrowly than the depth there",
                                f->folds));
    return ISO_OK;
}

static iso_status run(work *w) {
    ISO_TRY(iso_mesh_read(&w->mesh, w->arguments->file[0]));
    ISO_TRY(iso_report_add_input(&w->report, w->arguments->file[0], &w->mesh));
    ISO_TRY(iso_channels_new(&w->channels, &w->mesh, &w->options));
    w->report.channels = iso_channels_figures(w->channels);
    ISO_TRY(warn(w));
    ISO_TRY(iso_channels_check(w->channels));
    return write_result(w);
}

static void print_wall(const char *what, const iso_channel_wall *wall) {
    if (wall->channel >= 0)
        fprintf(stderr, "  %-10s %.3f mm of wall\n", what, wall->thickness);
}

static void print_summary(const work *w) {
    const iso_channel_figures *f = w->report.channels;
    if (!w->arguments->progress || w->arguments->quiet || !f)
        return;
    fprintf(stderr, "%s\n", w->path);
    fprintf(stderr, "  channels   %d, %d rings, %.1f mm long, %.1f mm3\n", f->channel_count,
            f->ring_count, f->length, f->volume);
    fprintf(stderr, "  pitch      %+.3f %% in all, %.3f %% rms, %.3f %% at most\n",
            100 * f->pitch_total, 100 * f->pitch_rms, 100 * f->pitch_max);
    fprintf(stderr, "  heights    %.2f %% rms from point to point\n", 100 * f->spread_rms);
    fprintf(stderr, "  bends      %.3f mm of radius at least\n", f->bend);
    print_wall("to part", &f->to_part);
    print_wall("between", &f->between);
    print_wall("outside", &f->outside);
    fprintf(stderr, "  mould      %.2f x %.2f x %.2f mm, %.1f mm3\n", f->box_max.x - f->box_min.x,
            f->box_max.y - f->box_min.y, f->box_max.z - f->box_min.z, f->mould_volume);
}

iso_status iso_verb_channels(const iso_arguments *arguments) {
    struct rusage usage;
    ISO_TRY(iso_one_file(arguments));
    if (!arguments->output)
        return iso_fail(ISO_USAGE, "say with -o where the channels go: to a file that ends in "
                                   ".stl, .mlk or .svg");
    work w = {.arguments = arguments, .path = arguments->output, .begun = clock_seconds()};
    ISO_TRY(choose(&w));
    iso_status status = run(&w);
    iso_progress_clear(&w.line);
    w.report.seconds = clock_seconds() - w.begun;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        w.report.peak_memory_kib = usage.ru_maxrss;
    if (status == ISO_OK)
        print_summary(&w);
    status = iso_finish_job(&w.report, arguments, &arguments->options, status);
    iso_channels_free(w.channels);
    iso_mesh_free(&w.mesh);
    iso_report_free(&w.report);
    return status;
}
