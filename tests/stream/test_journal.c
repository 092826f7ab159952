#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/memory.h"
#include "check.h"
#include "stream/journal.h"

static char path[64];

static fio_stream_resume resume_of(int64_t n) {
    fio_stream_resume resume = {.accepted = n,
                                .sent = n + 3,
                                .number = n + 1001,
                                .made = n / 2,
                                .run_count = (int32_t)(n % (FIO_STREAM_RUNS + 1))};
    for (int i = 0; i < resume.run_count; i++)
        resume.runs[i] = (fio_stream_run){n + 1001 + 3 * i, 2};
    fio_track_reset(&resume.track);
    resume.track.position[0] = (double)n / 3;
    resume.track.position[3] = -0.1 * (double)n;
    resume.track.known[1] = resume.track.relative = true;
    resume.track.nozzle[7] = 210.5;
    resume.track.acceleration[2] = 1e-9 * (double)n;
    resume.track_made = resume.track;
    resume.track_made.offset[2] = -1.0 / 7;
    resume.track_made.homed_axes[2] = resume.track_made.retracted = true;
    resume.track_made.raised = 2;
    resume.track_made.tool = 3;
    return resume;
}

/* Field by field: the padding of structs is nobody's. */
static bool same_track(const fio_track *a, const fio_track *b) {
    for (int i = 0; i < 4; i++)
        if (a->position[i] != b->position[i] || a->known[i] != b->known[i])
            return false;
    for (int i = 0; i < 3; i++)
        if (a->offset[i] != b->offset[i] || a->homed_axes[i] != b->homed_axes[i] ||
            a->acceleration[i] != b->acceleration[i])
            return false;
    for (int i = 0; i < FIO_TRACK_TOOLS; i++)
        if (a->nozzle[i] != b->nozzle[i])
            return false;
    return a->homed == b->homed && a->inches == b->inches && a->relative == b->relative &&
           a->relative_extrusion == b->relative_extrusion && a->feedrate == b->feedrate &&
           a->fan == b->fan && a->bed == b->bed && a->tool == b->tool &&
           a->feedrate_percent == b->feedrate_percent && a->flow_percent == b->flow_percent &&
           a->retracted == b->retracted && a->raised == b->raised;
}

static bool same(const fio_stream_resume *a, const fio_stream_resume *b) {
    for (int i = 0; i < a->run_count; i++)
        if (a->runs[i].number != b->runs[i].number || a->runs[i].count != b->runs[i].count)
            return false;
    return a->accepted == b->accepted && a->sent == b->sent && a->number == b->number &&
           a->made == b->made && a->run_count == b->run_count && same_track(&a->track, &b->track) &&
           same_track(&a->track_made, &b->track_made);
}

static fio_journal_job some_job(void) {
    fio_journal_job job = {.size = 123456789, .fingerprint = 0xfedcba9876543210u};
    strcpy(job.path, "/home/me/100% of \"it\"/p\xc3\xa4rt \n1.gcode");
    strcpy(job.port, "usb:2341:0042:SERIAL");
    return job;
}

static fio_journal *create(void) {
    fio_journal *journal = NULL;
    fio_journal_job job = some_job();
    CHECK_EQUAL(FIO_OK, fio_journal_create(&journal, path, &job, NULL));
    return journal;
}

static void test_what_was_added_last_is_read(void) {
    fio_journal *journal = create();
    fio_journal_job job, expected = some_job();
    fio_stream_resume resume;
    CHECK_EQUAL(FIO_UNREADABLE, fio_journal_read(path, &job, &resume)); /* no record yet */
    for (int64_t n = 0; n < 40; n++) {
        fio_stream_resume added = resume_of(n);
        CHECK_EQUAL(FIO_OK, fio_journal_add(journal, &added));
        CHECK_EQUAL(FIO_OK, fio_journal_read(path, &job, &resume));
        CHECK(same(&added, &resume));
    }
    CHECK(!strcmp(expected.path, job.path) && !strcmp(expected.port, job.port));
    CHECK_EQUAL(expected.size, job.size);
    CHECK(expected.fingerprint == job.fingerprint);
    fio_journal_close(journal, false);
    CHECK_EQUAL(0, access(path, F_OK));
    journal = create();
    fio_journal_close(journal, true);
    CHECK_EQUAL(-1, access(path, F_OK));
    CHECK_EQUAL(FIO_UNREADABLE, fio_journal_read(path, &job, &resume));
}

static size_t load(char *bytes, size_t capacity) {
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(bytes, 1, capacity, file) : 0;
    if (file)
        fclose(file);
    return size;
}

static void store(const char *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size)
        abort();
    fclose(file);
}

static size_t write_some(char *bytes, size_t capacity) {
    fio_journal *journal = create();
    for (int64_t n = 0; n < 6; n++) {
        fio_stream_resume added = resume_of(n);
        CHECK_EQUAL(FIO_OK, fio_journal_add(journal, &added));
    }
    fio_journal_close(journal, false);
    return load(bytes, capacity);
}

static bool is_one_of_ours(const fio_stream_resume *resume) {
    fio_stream_resume expected = resume_of(resume->accepted);
    return resume->accepted >= 0 && resume->accepted < 6 && same(&expected, resume);
}

static void test_a_file_cut_anywhere_gives_its_last_whole_record(void) {
    static char bytes[65536];
    size_t size = write_some(bytes, sizeof bytes);
    int64_t last = -1;
    for (size_t cut = 0; cut < size; cut++) {
        if (cut % 7 != 0 && size - cut > 40)
            continue;
        fio_journal_job job;
        fio_stream_resume resume;
        store(bytes, cut);
        fio_status status = fio_journal_read(path, &job, &resume);
        if (status != FIO_OK) {
            CHECK_EQUAL(FIO_UNREADABLE, status);
            CHECK_EQUAL(-1, last);
            continue;
        }
        CHECK(is_one_of_ours(&resume));
        CHECK(resume.accepted >= last);
        last = resume.accepted;
    }
    store(bytes, size);
    fio_journal_job job;
    fio_stream_resume resume;
    CHECK_EQUAL(FIO_OK, fio_journal_read(path, &job, &resume));
    CHECK_EQUAL(5, resume.accepted);
    unlink(path);
}

static void test_a_damaged_file_gives_nothing_that_was_not_written(void) {
    static char bytes[65536];
    size_t size = write_some(bytes, sizeof bytes);
    uint64_t state = 99;
    for (int round = 0; round < 2000; round++) {
        fio_journal_job job;
        fio_stream_resume resume;
        int count = 1 + round % 5;
        static char damaged[65536];
        memcpy(damaged, bytes, size);
        for (int i = 0; i < count; i++) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            damaged[(state >> 33) % size] ^= (char)(1 << (state >> 20 & 7));
        }
        store(damaged, size);
        if (fio_journal_read(path, &job, &resume) == FIO_OK)
            CHECK(is_one_of_ours(&resume));
    }
    unlink(path);
}

static long size_of_file(void) {
    FILE *file = fopen(path, "rb");
    long size = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (file)
        fclose(file);
    return size;
}

static void test_a_long_journal_is_written_anew(void) {
    fio_journal *journal = create();
    fio_stream_resume added = resume_of(0);
    long size = 0, largest = 0;
    for (int64_t n = 0; n < 400000 && size >= largest; n++) {
        added = resume_of(n);
        CHECK_EQUAL(FIO_OK, fio_journal_add(journal, &added));
        if (n % 500 != 0)
            continue;
        largest = size;
        size = size_of_file();
    }
    CHECK(largest > 32 << 20 && largest < 65 << 20);
    CHECK(size > 0 && size < 1 << 20);
    fio_journal_job job;
    fio_stream_resume resume;
    CHECK_EQUAL(FIO_OK, fio_journal_read(path, &job, &resume));
    CHECK(same(&added, &resume));
    fio_journal_close(journal, true);
}

static unsigned long crc_of(const char *bytes, size_t size) {
    unsigned long crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= (unsigned char)bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return crc ^ 0xffffffffu;
}

/* The machine was started anew: records may be missing, so the numbers prove nothing any more. */
static void test_numbers_of_another_boot_are_not_trusted(void) {
    static char bytes[40000], other[40100];
    size_t size = write_some(bytes, sizeof bytes - 1);
    bytes[size] = 0;
    char *end = strchr(bytes, '\n'), *sum = end;
    while (sum > bytes && sum[-1] != ' ')
        sum--;
    if (sum < bytes + 2)
        abort();
    sum[-2] = sum[-2] == '0' ? '1' : '0'; /* the last letter of the boot's name */
    int length = snprintf(other, sizeof other, "%.*s%lx%s", (int)(sum - bytes), bytes,
                          crc_of(bytes, (size_t)(sum - bytes)), end);
    store(other, (size_t)length);
    fio_journal_job job;
    fio_stream_resume resume, last = resume_of(5);
    CHECK_EQUAL(FIO_OK, fio_journal_read(path, &job, &resume));
    CHECK_EQUAL(-1, resume.number);
    CHECK_EQUAL(0, resume.run_count);
    CHECK_EQUAL(last.made, resume.made);
}

/* The child tells by a pipe what add() had returned for when it was killed: that must be there. */
static void test_it_survives_a_killed_host(void) {
    for (int round = 0; round < 12; round++) {
        int ends[2];
        if (pipe(ends) != 0)
            abort();
        fflush(NULL);
        pid_t child = fork();
        if (child == 0) {
            fio_journal *journal = create();
            for (int64_t n = 0;; n++) {
                fio_stream_resume added = resume_of(n);
                if (fio_journal_add(journal, &added) != FIO_OK ||
                    write(ends[1], &n, sizeof n) != (ssize_t)sizeof n)
                    _exit(1);
            }
        }
        close(ends[1]);
        int64_t told = -1, n;
        for (int i = 0; i < 3 + 7 * round && read(ends[0], &n, sizeof n) == (ssize_t)sizeof n; i++)
            told = n;
        kill(child, SIGKILL);
        while (read(ends[0], &n, sizeof n) == (ssize_t)sizeof n)
            told = n;
        close(ends[0]);
        waitpid(child, NULL, 0);
        fio_journal_job job;
        fio_stream_resume resume;
        CHECK_EQUAL(FIO_OK, fio_journal_read(path, &job, &resume));
        fio_stream_resume expected = resume_of(resume.accepted);
        CHECK(same(&expected, &resume));
        CHECK(resume.accepted >= told && resume.accepted <= told + 1);
        CHECK(told >= 2 + 7 * round);
        unlink(path);
    }
}

/* As on a full disk: the head would fit, the record does not. */
static void test_a_journal_is_not_lost_to_one_that_can_t_be_begun(void) {
    static char bytes[65536];
    fio_journal_job job = some_job();
    fio_stream_resume resume, before = resume_of(3), from = resume_of(5);
    fio_journal *journal = create();
    rlim_t head = (rlim_t)load(bytes, sizeof bytes);
    CHECK_EQUAL(FIO_OK, fio_journal_add(journal, &before));
    fio_journal_close(journal, false);
    struct rlimit usual, full;
    getrlimit(RLIMIT_FSIZE, &usual);
    full = usual;
    full.rlim_cur = head + 100;
    fflush(NULL);
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &full);
    fio_status status = fio_journal_create(&journal, path, &job, &from);
    setrlimit(RLIMIT_FSIZE, &usual);
    CHECK_EQUAL(FIO_NOT_WRITTEN, status);
    CHECK_EQUAL(FIO_OK, fio_journal_read(path, &job, &resume));
    CHECK(same(&before, &resume));
    CHECK_EQUAL(FIO_OK, fio_journal_create(&journal, path, &job, &from));
    CHECK_EQUAL(FIO_OK, fio_journal_read(path, &job, &resume));
    CHECK(same(&from, &resume));
    fio_journal_close(journal, true);
}

/* A right checksum does not make sense of what a tool, a line's number or a place can't be. */
static void test_values_out_of_range_are_no_record(void) {
    for (int i = 0; i < 9; i++) {
        fio_stream_resume added = resume_of(5), resume;
        fio_journal_job job;
        int64_t *const numbers[5] = {&added.made, &added.accepted, &added.sent, &added.number,
                                     &added.runs[2].count};
        if (i < 5)
            *numbers[i] = INT64_MAX - 1;
        else if (i == 5)
            added.runs[0].number = -1;
        else if (i == 6)
            added.track.tool = FIO_TRACK_TOOLS;
        else if (i == 7)
            added.track_made.tool = -1;
        else
            added.track_made.position[2] = (double)NAN;
        fio_journal *journal = create();
        CHECK_EQUAL(FIO_OK, fio_journal_add(journal, &added));
        fio_journal_close(journal, false);
        CHECK_EQUAL(FIO_UNREADABLE, fio_journal_read(path, &job, &resume));
    }
    unlink(path);
}

static void test_errors_say_which_file(void) {
    fio_journal *journal;
    fio_journal_job job = some_job();
    CHECK_EQUAL(FIO_NOT_WRITTEN, fio_journal_create(&journal, "/nowhere/at/all", &job, NULL));
    CHECK(strstr(fio_error_message(), "/nowhere/at/all"));
    CHECK(journal == NULL);
    fio_fail_allocation_after(0);
    CHECK_EQUAL(FIO_NO_MEMORY, fio_journal_create(&journal, path, &job, NULL));
    fio_fail_allocation_after(-1);
    fio_journal_close(NULL, true);
}

int main(void) {
    snprintf(path, sizeof path, "/tmp/isoprint-test-journal-%ld", (long)getpid());
    RUN(test_what_was_added_last_is_read);
    RUN(test_a_file_cut_anywhere_gives_its_last_whole_record);
    RUN(test_a_damaged_file_gives_nothing_that_was_not_written);
    RUN(test_a_long_journal_is_written_anew);
    RUN(test_numbers_of_another_boot_are_not_trusted);
    RUN(test_it_survives_a_killed_host);
    RUN(test_a_journal_is_not_lost_to_one_that_can_t_be_begun);
    RUN(test_values_out_of_range_are_no_record);
    RUN(test_errors_say_which_file);
    return check_verdict();
}
