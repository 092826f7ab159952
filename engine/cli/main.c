/* The program isoslice. */
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/output.h"
#include "verbs.h"

iso_status iso_one_file(const iso_arguments *arguments) {
    if (arguments->file_count == 1)
        return ISO_OK;
    return iso_fail(ISO_USAGE,
                    arguments->file_count == 0 ? "no file given; see isoslice %s --help"
                                               : "more than one file given; see isoslice %s --help",
                    iso_verb_name(arguments->verb));
}

iso_status iso_replace_ending(char *out, size_t size, const char *file, const char *ending) {
    const char *base = strrchr(file, '/');
    base = base ? base + 1 : file;
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot > base ? (size_t)(dot - file) : strlen(file);
    if (strcmp(file, "-") == 0)
        return iso_fail(ISO_USAGE, "say with -o where the result goes");
    if (length + strlen(ending) >= size)
        return iso_fail(ISO_USAGE, "%.60s...: the name is too long", file);
    snprintf(out, size, "%.*s%s", (int)length, file, ending);
    return ISO_OK;
}

bool iso_ends_in(const char *path, const char *ending) {
    size_t length = strlen(path), n = strlen(ending);
    return length > n && strcasecmp(path + length - n, ending) == 0;
}

iso_status iso_keep_files(const iso_arguments *arguments, const char *path) {
    struct stat result, file;
    if (!path || strcmp(path, "-") == 0 || stat(path, &result) != 0)
        return ISO_OK;
    for (int32_t i = 0; i < arguments->file_count; i++)
        if (stat(arguments->file[i], &file) == 0 && file.st_dev == result.st_dev &&
            file.st_ino == result.st_ino)
            return iso_fail(ISO_USAGE,
                            "%s: the result would take the place of what it is made from", path);
    return ISO_OK;
}

/* Take the unfinished file along, then end as the signal would have ended us. */
static void on_signal(int number) {
    iso_output_remove_unfinished();
    signal(number, SIG_DFL);
    raise(number);
}

static void catch_signals(void) {
    static const int ending[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = on_signal};
    for (size_t i = 0; i < sizeof ending / sizeof *ending; i++) {
        struct sigaction before;
        if (sigaction(ending[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(ending[i], &action, NULL);
    }
    /* a reader that went away is output that can't be written, not a sudden death */
    signal(SIGPIPE, SIG_IGN);
}

static iso_status run(const iso_arguments *arguments) {
    static iso_status (*const verb[])(const iso_arguments *) = {
        iso_verb_slice,   iso_verb_contours, iso_verb_info,
        iso_verb_preview, iso_verb_lattice,  iso_verb_channels};
    if (arguments->page != ISO_PAGE_NONE)
        return iso_page_print(arguments);
    return verb[arguments->verb](arguments);
}

int main(int argc, char **argv) {
    static iso_arguments arguments; /* too much for a stack */
    catch_signals();
    iso_status status = iso_arguments_read(&arguments, argc, argv);
    if (status == ISO_OK)
        status = run(&arguments);
    if (status != ISO_OK)
        fprintf(stderr, "isoslice: %s\n", iso_error_message());
    if (fflush(stdout) != 0 && status == ISO_OK) {
        fprintf(stderr, "isoslice: standard output can't be written\n");
        status = ISO_NOT_WRITTEN;
    }
    return (int)status;
}
