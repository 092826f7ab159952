/* One record a line: its fields, parted by blanks, and the CRC-32 of all that is before it. Numbers
 * are hexadecimal, doubles by their bits, so that nothing is rounded; texts are percent-encoded.
 *
 * A record is in the kernel's hands when fio_journal_add() returns, which a killed process can't
 * undo, and on the disk soon after: to wait for a slow disk would let the printer's planner run
 * empty. What a crash of the machine itself loses is known by its boot: numbers of lines written
 * down in another boot are not to be trusted, as later records may be missing. */
#define _POSIX_C_SOURCE 200809L
#include "stream/journal.h"

#include <aio.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/text.h"

enum {
    RECORD_MOST = 8192,
    BOOT_MOST = 64,
    REWRITE_BYTES = 64 << 20 /* a longer file is written anew */
};

#define COUNT_MOST (INT64_C(1) << 60)

struct fio_journal {
    int file;
    int64_t size;
    struct aiocb sync;    /* what brings the file to the disk */
    bool syncing, behind; /* records were added since it began */
    fio_journal_job job;
    char path[1024];
};

typedef struct fio_fields {
    const char *at;
    bool good;
} fio_fields;

static uint32_t crc_of(const char *bytes, size_t size) {
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= (unsigned char)bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

static void put_hex(fio_text *text, uint64_t value) {
    char digits[17];
    int count = 16;
    digits[16] = 0;
    do
        digits[--count] = "0123456789abcdef"[value & 15];
    while ((value >>= 4) && count > 0);
    fio_text_string(text, digits + count);
    fio_text_string(text, " ");
}

static void put_double(fio_text *text, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_hex(text, bits);
}

static void put_string(fio_text *text, const char *string) {
    for (; *string; string++) {
        unsigned char c = (unsigned char)*string;
        if (c > ' ' && c != '%' && c < 127) {
            fio_text_bytes(text, string, 1);
        } else {
            char code[3] = {'%', "0123456789abcdef"[c >> 4], "0123456789abcdef"[c & 15]};
            fio_text_bytes(text, code, 3);
        }
    }
    fio_text_string(text, " ");
}

static int digit(char c) {
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

static uint64_t get_hex(fio_fields *fields) {
    uint64_t value = 0;
    int count = 0;
    while (digit(*fields->at) >= 0 && count < 16) {
        value = value << 4 | (uint64_t)digit(*fields->at++);
        count++;
    }
    if (count == 0 || *fields->at != ' ')
        fields->good = false;
    else
        fields->at++;
    return value;
}

static double get_double(fio_fields *fields) {
    double value;
    uint64_t bits = get_hex(fields);
    memcpy(&value, &bits, sizeof value);
    fields->good = fields->good && isfinite(value);
    return value;
}

static void get_string(fio_fields *fields, char *string, size_t capacity) {
    size_t length = 0;
    const char *p = fields->at;
    while (*p && *p != ' ' && length + 1 < capacity) {
        char c = *p++;
        if (c == '%' && digit(p[0]) >= 0 && digit(p[1]) >= 0) {
            c = (char)(digit(p[0]) << 4 | digit(p[1]));
            p += 2;
        }
        string[length++] = c;
    }
    string[length] = 0;
    fields->good = fields->good && *p == ' ';
    fields->at = p + (*p == ' ');
}

static void put_track(fio_text *text, const fio_track *track) {
    unsigned flags = 0;
    for (int i = 0; i < 4; i++) {
        put_double(text, track->position[i]);
        flags |= (unsigned)track->known[i] << i;
    }
    flags |= (unsigned)track->homed << 4 | (unsigned)track->inches << 5 |
             (unsigned)track->relative << 6 | (unsigned)track->relative_extrusion << 7 |
             (unsigned)track->retracted << 8;
    for (int i = 0; i < 3; i++) {
        flags |= (unsigned)track->homed_axes[i] << (9 + i);
        put_double(text, track->offset[i]);
        put_double(text, track->acceleration[i]);
    }
    put_double(text, track->raised);
    put_hex(text, flags);
    put_double(text, track->feedrate);
    put_double(text, track->fan);
    for (int i = 0; i < FIO_TRACK_TOOLS; i++)
        put_double(text, track->nozzle[i]);
    put_double(text, track->bed);
    put_hex(text, (uint64_t)track->tool);
    put_double(text, track->feedrate_percent);
    put_double(text, track->flow_percent);
}

static void get_track(fio_fields *fields, fio_track *track) {
    for (int i = 0; i < 4; i++)
        track->position[i] = get_double(fields);
    for (int i = 0; i < 3; i++) {
        track->offset[i] = get_double(fields);
        track->acceleration[i] = get_double(fields);
    }
    track->raised = get_double(fields);
    uint64_t flags = get_hex(fields);
    for (int i = 0; i < 3; i++)
        track->homed_axes[i] = flags >> (9 + i) & 1;
    for (int i = 0; i < 4; i++)
        track->known[i] = flags >> i & 1;
    track->homed = flags >> 4 & 1;
    track->inches = flags >> 5 & 1;
    track->relative = flags >> 6 & 1;
    track->relative_extrusion = flags >> 7 & 1;
    track->retracted = flags >> 8 & 1;
    track->feedrate = get_double(fields);
    track->fan = get_double(fields);
    for (int i = 0; i < FIO_TRACK_TOOLS; i++)
        track->nozzle[i] = get_double(fields);
    track->bed = get_double(fields);
    uint64_t tool = get_hex(fields);
    fields->good = fields->good && tool < FIO_TRACK_TOOLS;
    track->tool = fields->good ? (int)tool : 0;
    track->feedrate_percent = get_double(fields);
    track->flow_percent = get_double(fields);
}

/* Of this start of the machine; "" where there is no such thing. */
static void find_boot(char boot[BOOT_MOST]) {
    int file = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
    ssize_t length = file < 0 ? 0 : read(file, boot, BOOT_MOST - 1);
    if (file >= 0)
        close(file);
    boot[length > 0 ? length : 0] = 0;
    boot[strcspn(boot, "\n")] = 0;
}

static size_t write_job(char *record, const fio_journal_job *job) {
    fio_text text = fio_text_in(record, RECORD_MOST);
    fio_text_string(&text, "isoprint-job 1 ");
    put_string(&text, job->path);
    put_string(&text, job->port);
    put_hex(&text, (uint64_t)job->size);
    put_hex(&text, job->fingerprint);
    char boot[BOOT_MOST];
    find_boot(boot);
    put_string(&text, boot);
    return text.length;
}

/* *same_boot: the machine has not been started anew since. */
static bool read_job(const char *record, fio_journal_job *job, bool *same_boot) {
    fio_fields fields = {record, true};
    static const char head[] = "isoprint-job 1 ";
    if (strncmp(record, head, sizeof head - 1) != 0)
        return false;
    fields.at += sizeof head - 1;
    get_string(&fields, job->path, sizeof job->path);
    get_string(&fields, job->port, sizeof job->port);
    job->size = (int64_t)get_hex(&fields);
    job->fingerprint = get_hex(&fields);
    char boot[BOOT_MOST], now[BOOT_MOST];
    get_string(&fields, boot, sizeof boot);
    find_boot(now);
    *same_boot = *boot && strcmp(boot, now) == 0;
    return fields.good;
}

static size_t write_resume(char *record, const fio_stream_resume *resume) {
    fio_text text = fio_text_in(record, RECORD_MOST);
    fio_text_string(&text, "at ");
    put_hex(&text, (uint64_t)resume->accepted);
    put_hex(&text, (uint64_t)resume->sent);
    put_hex(&text, (uint64_t)resume->number);
    put_hex(&text, (uint64_t)resume->made);
    put_hex(&text, (uint64_t)resume->run_count);
    for (int i = 0; i < resume->run_count && i < FIO_STREAM_RUNS; i++) {
        put_hex(&text, (uint64_t)resume->runs[i].number);
        put_hex(&text, (uint64_t)resume->runs[i].count);
    }
    put_track(&text, &resume->track);
    put_track(&text, &resume->track_made);
    return text.length;
}

/* Numbers that no firmware counts to would overflow where they are reckoned with. */
static bool makes_sense(const fio_stream_resume *resume) {
    bool good = resume->made >= 0 && resume->made <= COUNT_MOST && resume->accepted >= 0 &&
                resume->accepted <= resume->sent && resume->sent <= COUNT_MOST &&
                resume->number >= -1 && resume->number <= COUNT_MOST;
    for (int i = 0; i < resume->run_count; i++) {
        const fio_stream_run *run = &resume->runs[i];
        good = good && run->number >= 0 && run->number <= COUNT_MOST && run->count >= 0 &&
               run->count <= COUNT_MOST;
    }
    return good;
}

static bool read_resume(const char *record, fio_stream_resume *resume) {
    fio_fields fields = {record + 3, true};
    *resume = (fio_stream_resume){0};
    if (strncmp(record, "at ", 3) != 0)
        return false;
    resume->accepted = (int64_t)get_hex(&fields);
    resume->sent = (int64_t)get_hex(&fields);
    resume->number = (int64_t)get_hex(&fields);
    resume->made = (int64_t)get_hex(&fields);
    uint64_t runs = get_hex(&fields);
    if (!fields.good || runs > FIO_STREAM_RUNS)
        return false;
    resume->run_count = (int32_t)runs;
    for (uint64_t i = 0; i < runs; i++) {
        resume->runs[i].number = (int64_t)get_hex(&fields);
        resume->runs[i].count = (int64_t)get_hex(&fields);
    }
    get_track(&fields, &resume->track);
    get_track(&fields, &resume->track_made);
    return fields.good && makes_sense(resume);
}

static fio_status fail_to_write(const char *path) {
    return fio_fail(FIO_NOT_WRITTEN, "the journal %s can't be written: %s", path, strerror(errno));
}

static fio_status append(int file, const char *path, char *record, size_t length) {
    fio_text text = {record, RECORD_MOST, length};
    put_hex(&text, crc_of(record, length));
    record[text.length - 1] = '\n';
    for (size_t done = 0; done < text.length;) {
        ssize_t count = write(file, record + done, text.length - done);
        if (count < 0 && errno != EINTR)
            return fail_to_write(path);
        done += count > 0 ? (size_t)count : 0;
    }
    return FIO_OK;
}

static void finish_sync(fio_journal *journal) {
    const struct aiocb *const list[1] = {&journal->sync};
    while (journal->syncing && aio_error(&journal->sync) == EINPROGRESS)
        aio_suspend(list, 1, NULL);
    if (journal->syncing)
        aio_return(&journal->sync);
    journal->syncing = false;
}

/* One at a time: what is added meanwhile goes with the next. */
static fio_status start_sync(fio_journal *journal) {
    journal->behind = true;
    if (journal->syncing) {
        int error = aio_error(&journal->sync);
        if (error == EINPROGRESS)
            return FIO_OK;
        aio_return(&journal->sync);
        journal->syncing = false;
        if (error != 0) {
            errno = error;
            return fail_to_write(journal->path);
        }
    }
    journal->sync =
        (struct aiocb){.aio_fildes = journal->file, .aio_sigevent = {.sigev_notify = SIGEV_NONE}};
    if (aio_fsync(O_DSYNC, &journal->sync) != 0)
        return errno == EAGAIN ? FIO_OK : fail_to_write(journal->path);
    journal->syncing = true;
    journal->behind = false;
    return FIO_OK;
}

/* A new file beside the old one, which it replaces once it is on disk. */
static fio_status begin_file(fio_journal *journal, const fio_stream_resume *resume) {
    char beside[sizeof journal->path + 8], record[RECORD_MOST];
    snprintf(beside, sizeof beside, "%s.new", journal->path);
    int file = open(beside, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0)
        return fail_to_write(journal->path);
    fio_status status = append(file, beside, record, write_job(record, &journal->job));
    if (status == FIO_OK && resume)
        status = append(file, beside, record, write_resume(record, resume));
    if (status == FIO_OK && (fdatasync(file) != 0 || rename(beside, journal->path) != 0))
        status = fail_to_write(journal->path);
    if (status != FIO_OK) {
        close(file);
        unlink(beside);
        return status;
    }
    finish_sync(journal);
    if (journal->file >= 0)
        close(journal->file);
    journal->file = file;
    journal->size = 0;
    return FIO_OK;
}

fio_status fio_journal_create(fio_journal **journal, const char *path, const fio_journal_job *job,
                              const fio_stream_resume *from) {
    *journal = NULL;
    fio_journal *made = fio_allocate(sizeof *made);
    if (!made)
        return fio_fail(FIO_NO_MEMORY, "no memory for a journal");
    if (strlen(path) >= sizeof made->path) {
        fio_release(made);
        return fio_fail(FIO_USAGE, "the journal's path is too long");
    }
    strcpy(made->path, path);
    made->job = *job;
    made->file = -1;
    fio_status status = begin_file(made, from);
    if (status != FIO_OK) {
        fio_release(made);
        return status;
    }
    *journal = made;
    return FIO_OK;
}

fio_status fio_journal_add(fio_journal *journal, const fio_stream_resume *resume) {
    char record[RECORD_MOST];
    if (journal->size > REWRITE_BYTES)
        return begin_file(journal, resume);
    size_t length = write_resume(record, resume);
    fio_status status = append(journal->file, journal->path, record, length);
    if (status != FIO_OK)
        return status;
    journal->size += (int64_t)length + 10;
    return start_sync(journal);
}

void fio_journal_close(fio_journal *journal, bool done) {
    if (!journal)
        return;
    finish_sync(journal);
    if (!done && journal->behind)
        (void)fdatasync(journal->file);
    close(journal->file);
    if (done)
        unlink(journal->path);
    fio_release(journal);
}

/* Whether the line, without its end, has the right checksum; cuts it off. */
static bool check_record(char *record, size_t length) {
    char *last = strrchr(record, ' ');
    if (!last || length == 0 || strlen(record) != length)
        return false;
    char sum[20];
    fio_text text = fio_text_in(sum, sizeof sum);
    put_hex(&text, crc_of(record, (size_t)(last + 1 - record)));
    sum[text.length - 1] = 0;
    if (strcmp(sum, last + 1) != 0)
        return false;
    last[1] = 0;
    return true;
}

fio_status fio_journal_read(const char *path, fio_journal_job *job, fio_stream_resume *resume) {
    char record[RECORD_MOST];
    FILE *file = fopen(path, "re");
    if (!file)
        return fio_fail(FIO_UNREADABLE, "the journal %s can't be read: %s", path, strerror(errno));
    bool has_job = false, has_resume = false, same_boot = false;
    fio_journal_job read_as;
    fio_stream_resume at, last = {0};
    while (fgets(record, sizeof record, file)) {
        size_t length = strlen(record);
        if (length == 0 || record[length - 1] != '\n')
            continue; /* cut off, or longer than any record */
        record[--length] = 0;
        if (!check_record(record, length))
            continue;
        if (!has_job && read_job(record, &read_as, &same_boot))
            has_job = true;
        else if (read_resume(record, &at)) {
            last = at;
            has_resume = true;
        }
    }
    fclose(file);
    if (!has_job || !has_resume)
        return fio_fail(FIO_UNREADABLE, "%s is no journal of a job, or none with a whole record",
                        path);
    *job = read_as;
    *resume = last;
    if (!same_boot) {
        resume->number = -1;
        resume->run_count = 0;
    }
    return FIO_OK;
}
