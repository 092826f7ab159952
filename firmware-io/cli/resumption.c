#define _XOPEN_SOURCE 700 /* realpath() */

#include "resumption.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "terminal.h"

static bool is_line(const char *text) {
    return text[strspn(text, "0123456789")] == 0;
}

static bool no_journal(const fio_arguments *arguments, const fio_job *job) {
    if (arguments->journal)
        return !strcmp(arguments->journal, "none");
    return job->is_pipe && !(arguments->resume_from && !is_line(arguments->resume_from));
}

fio_status fio_resumption_read(fio_resumption *resumption, const fio_arguments *arguments) {
    const char *from = arguments->resume_from;
    resumption->journal = NULL;
    resumption->resumes = false;
    resumption->port = NULL;
    resumption->job = (fio_journal_job){0};
    snprintf(resumption->file, sizeof resumption->file, "%s",
             arguments->file ? arguments->file : "");
    if (!from)
        return FIO_OK;
    if (is_line(from)) {
        return arguments->file
                   ? FIO_OK
                   : fio_fail(FIO_USAGE, "--resume-from %.20s: which file? None is given", from);
    }
    fio_status status = fio_journal_read(from, &resumption->job, &resumption->from);
    if (status != FIO_OK)
        return status;
    resumption->resumes = true;
    resumption->port = resumption->job.port;
    if (!arguments->file)
        snprintf(resumption->file, sizeof resumption->file, "%s", resumption->job.path);
    return FIO_OK;
}

fio_status fio_resumption_match(fio_resumption *resumption, const fio_arguments *arguments,
                                fio_job *job) {
    const char *from = arguments->resume_from;
    if (resumption->resumes && !job->is_pipe) {
        if (fio_source_fingerprint(job->source) == resumption->job.fingerprint &&
            fio_source_whole(job->source)->bytes == resumption->job.size)
            return FIO_OK;
        return fio_fail(FIO_USAGE,
                        "%s is not the file that %s belongs to, or has changed since; nothing was "
                        "sent",
                        job->name, from);
    }
    if (!from || resumption->resumes)
        return FIO_OK;
    if (job->is_pipe)
        return fio_fail(FIO_USAGE,
                        "--resume-from %.20s: standard input can be gone on with only "
                        "from a journal",
                        from);
    resumption->resumes = true;
    return fio_job_find_line(job, strtoll(from, NULL, 10), &resumption->from);
}

/* ---- the journal of this job ---- */

static fio_status name_journal(fio_resumption *resumption, const fio_arguments *arguments) {
    const char *path = arguments->journal, *from = arguments->resume_from;
    int length;
    if (path)
        length = snprintf(resumption->journal_path, sizeof resumption->journal_path, "%s", path);
    else if (from && !is_line(from))
        length = snprintf(resumption->journal_path, sizeof resumption->journal_path, "%s", from);
    else
        length = snprintf(resumption->journal_path, sizeof resumption->journal_path, "%s.journal",
                          resumption->file);
    return (size_t)length < sizeof resumption->journal_path
               ? FIO_OK
               : fio_fail(FIO_USAGE, "%.40s...: the name of the journal is too long",
                          resumption->journal_path);
}

static bool ends_as_journal(const char *path) {
    static const char ending[] = ".journal";
    size_t length = strlen(path);
    return length >= sizeof ending && !strcmp(path + length - (sizeof ending - 1), ending);
}

fio_status fio_resumption_check(fio_resumption *resumption, const fio_arguments *arguments,
                                const fio_job *job) {
    static fio_journal_job earlier; /* too much for a stack */
    static fio_stream_resume where;
    struct stat about;
    resumption->journal_path[0] = 0;
    if (no_journal(arguments, job))
        return FIO_OK;
    fio_status status = name_journal(resumption, arguments);
    const char *path = resumption->journal_path;
    if (status != FIO_OK || stat(path, &about) != 0)
        return status;
    if (!S_ISREG(about.st_mode)) /* it is replaced by renaming: no device must be */
        return fio_fail(FIO_NOT_WRITTEN, "%s: not a file that a journal could be", path);
    if (about.st_size == 0)
        return FIO_OK;
    if (fio_journal_read(path, &earlier, &where) != FIO_OK)
        return ends_as_journal(path)
                   ? FIO_OK /* one that never got to its first record */
                   : fio_fail(FIO_USAGE,
                              "%s is there and is no journal: it is left as it is; say with "
                              "--journal where else",
                              path);
    bool same = earlier.fingerprint == fio_source_fingerprint(job->source);
    if (resumption->resumes || arguments->yes || !same || where.sent == 0)
        return FIO_OK;
    char question[1400];
    snprintf(question, sizeof question,
             "%s: an earlier run of this job broke off after %" PRId64
             " commands. Begin anew, on an empty bed?",
             path, where.made);
    if (fio_terminal_confirm(question))
        return FIO_OK;
    return fio_fail(FIO_USAGE,
                    "an earlier run of this job broke off; go on with it by --resume-from %s, or "
                    "begin anew, on an empty bed, by --yes",
                    path);
}

fio_status fio_resumption_begin(fio_resumption *resumption, const fio_arguments *arguments,
                                const fio_job *job, fio_narrator *narrator) {
    static fio_journal_job about; /* too much for a stack */
    const char *path = resumption->journal_path;
    if (!*path)
        return FIO_OK;
    about = (fio_journal_job){.size = fio_source_whole(job->source)->bytes,
                              .fingerprint = fio_source_fingerprint(job->source)};
    fio_text whole = fio_text_in(about.path, sizeof about.path);
    char absolute[PATH_MAX];
    fio_text_string(&whole, !job->is_pipe && realpath(resumption->file, absolute)
                                ? absolute
                                : resumption->file);
    snprintf(about.port, sizeof about.port, "%s", resumption->port);
    fio_status status = fio_journal_create(&resumption->journal, path, &about,
                                           resumption->resumes ? &resumption->from : NULL);
    if (status == FIO_OK || arguments->journal)
        return status;
    char text[700];
    snprintf(text, sizeof text, "no journal is kept: %s", fio_error_message());
    fio_narrator_warn(narrator, text);
    return FIO_OK;
}

void fio_resumption_mark(fio_resumption *resumption, const fio_stream_resume *resume,
                         fio_narrator *narrator) {
    if (!resumption->journal || fio_journal_add(resumption->journal, resume) == FIO_OK)
        return;
    char text[700];
    snprintf(text, sizeof text, "the journal is no longer kept: %s", fio_error_message());
    fio_narrator_warn(narrator, text);
    /* What goes out from here on would be missing in it: going on from it would skip commands. */
    fio_journal_close(resumption->journal, true);
    resumption->journal = NULL;
}

/* ---- the command to go on with ---- */

/* As a shell takes it. */
static void quoted(fio_text *text, const char *word) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-+=./:,@%";
    if (*word && word[strspn(word, plain)] == 0 && *word != '-') {
        fio_text_string(text, word);
        return;
    }
    fio_text_string(text, "'");
    for (; *word; word++)
        if (*word == '\'')
            fio_text_string(text, "'\\''");
        else
            fio_text_bytes(text, word, 1);
    fio_text_string(text, "'");
}

static void describe(fio_text *text, const fio_resumption *resumption,
                     const fio_arguments *arguments, const fio_job *job, int64_t line) {
    fio_text_string(text, "isoprint ");
    if (job->is_pipe)
        fio_text_string(text, "-");
    else
        quoted(text, resumption->file);
    fio_text_string(text, " --resume-from ");
    if (resumption->journal)
        quoted(text, resumption->journal_path);
    else
        fio_text_integer(text, line);
    fio_text_string(text, " --port ");
    quoted(text, resumption->port);
    if (arguments->baud_given && arguments->baud > 0) {
        fio_text_string(text, " --baud ");
        fio_text_integer(text, arguments->baud);
    }
}

void fio_resumption_end(fio_resumption *resumption, const fio_arguments *arguments,
                        fio_status status, const fio_stream_report *report, fio_job *job,
                        char *command, size_t size) {
    fio_text text = fio_text_in(command, size);
    bool begun = report->resume.accepted > 0;
    bool possible = begun && status != FIO_OK && (resumption->journal || !job->is_pipe);
    if (resumption->journal && possible)
        (void)(fio_journal_add(resumption->journal, &report->resume) == FIO_OK);
    int64_t line = 0;
    if (possible && !resumption->journal)
        possible = fio_job_line_of(job, &line, report->resume.made) == FIO_OK;
    if (possible)
        describe(&text, resumption, arguments, job, line);
    if (resumption->journal)
        fio_journal_close(resumption->journal,
                          status == FIO_OK || (!begun && !resumption->resumes));
    resumption->journal = NULL;
}
