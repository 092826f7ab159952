#include "print.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "protocol/source.h"
#include "stream/session.h"

/* splitmix64, https://prng.di.unimi.it/splitmix64.c */
uint64_t print_random_next(print_random *random) {
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

int print_random_below(print_random *random, int limit) {
    return (int)(print_random_next(random) % (uint64_t)limit);
}

double print_random_unit(print_random *random) {
    return (double)(print_random_next(random) >> 11) * 0x1p-53;
}

static void add(print_job *job, const char *command) {
    snprintf(job->commands[job->count], PRINT_TEXT, "%s K%d", command, job->count);
    job->count++;
}

static void add_random(print_job *job, print_random *random, double *e, double step) {
    char command[PRINT_TEXT - 16];
    int kind = print_random_below(random, 40);
    double x = 20 + 200 * print_random_unit(random) * step;
    double y = 20 + 170 * print_random_unit(random) * step;
    if (kind == 0) {
        snprintf(command, sizeof command, "M106 S%d", print_random_below(random, 256));
    } else if (kind == 1) {
        snprintf(command, sizeof command, "M117 part %d of it", job->count);
    } else if (kind == 2) {
        snprintf(command, sizeof command, "M73 P%d R%d", job->count % 100, 100 - job->count % 100);
    } else if (kind == 3) {
        snprintf(command, sizeof command, "G4 P%d", 20 + print_random_below(random, 300));
    } else if (kind == 4) {
        snprintf(command, sizeof command, "G92 E0");
        *e = 0;
    } else if (kind == 5) {
        snprintf(command, sizeof command, "M104 S%d", 195 + print_random_below(random, 20));
    } else if (kind < 12) {
        snprintf(command, sizeof command, "G0 X%.3f Y%.3f F9000", x, y);
    } else {
        *e += 0.5 * step;
        snprintf(command, sizeof command, "G1 X%.3f Y%.3f E%.5f F%d", x, y, *e,
                 3000 + 100 * print_random_below(random, 30));
    }
    add(job, command);
}

void print_job_make(print_job *job, uint64_t seed, int moves) {
    static const char *const head[] = {"M140 S60",  "M104 S200", "G28",
                                       "G90",       "M82",       "G92 E0",
                                       "M109 S200", "M106 S0",   "G1 X5 Z0.3 F600"};
    static const char *const tail[] = {"M104 S0", "M140 S0", "M107", "G1 X1 Z20 F600", "M84"};
    print_random random = {seed};
    double e = 0, step = 0.02 + 0.2 * print_random_unit(&random);
    job->tiny = print_random_below(&random, 4) == 0;
    if (job->tiny)
        step *= 0.02; /* so short that the wire is what holds the print up */
    job->count = 0;
    for (size_t i = 0; i < sizeof head / sizeof *head; i++)
        add(job, head[i]);
    for (int i = 0; i < moves; i++)
        add_random(job, &random, &e, step);
    for (size_t i = 0; i < sizeof tail / sizeof *tail; i++)
        add(job, tail[i]);
    job->text = malloc((size_t)job->count * (PRINT_TEXT + 24) + 1);
    job->length = 0;
    for (int i = 0; i < job->count; i++)
        job->length += (size_t)sprintf(job->text + job->length, "%s%s\n%s", job->commands[i],
                                       i % 5 ? "" : " ; why", i % 50 ? "" : ";LAYER_CHANGE\n\n");
}

void print_job_free(print_job *job) {
    free(job->text);
}

static void note_wrong(print_record *record, const char *what, const char *text) {
    if (record->wrong++ == 0)
        snprintf(record->first_wrong, sizeof record->first_wrong, "%s: %.100s (%d was next)", what,
                 text, record->next);
}

/* The right line, but not what it says: damage that its checksum does not tell. */
static void note_altered(print_record *record, const char *text) {
    note_wrong(record, "altered", text);
    record->executed[record->next++]++;
}

/* "M0109" is what protects an M109 from becoming an M108: the same command. */
static bool same(const char *text, const char *command) {
    size_t zeros = strspn(text + (text[0] != 0), "0");
    bool disguised = text[0] == command[0] && zeros > 0 && command[1] != '0';
    return strcmp(disguised ? text + 1 + zeros : text, disguised ? command + 1 : command) == 0;
}

static void executed(void *context, const fio_executed *entry) {
    print_record *record = context;
    const char *key = strrchr(entry->text, 'K');
    if (record->verbose)
        printf("%10.4f ** %s (N%lld, %.4f s)\n", entry->start, entry->text,
               (long long)entry->number, entry->duration);
    bool known = strchr("GM", entry->text[0]); /* what isn't, a firmware only complains about */
    bool anew = fio_machine_count(record->machine)->resets > record->run_resets ||
                record->ending; /* numbers may have begun anew */
    bool turns = !anew && record->next >= 0 && entry->number >= 0 &&
                 record->number[record->next] == entry->number; /* by its number */
    if (!known || !key || key == entry->text || key[-1] != ' ') {
        if (turns)
            note_altered(record, entry->text);
        return;
    }
    char *end;
    long index = strtol(key + 1, &end, 10);
    bool right = !*end && index >= 0 && index < record->job->count &&
                 same(entry->text, record->job->commands[index]);
    if (entry->number < 0) { /* "N5 G1" that became "G5 G1" is no command, either */
        if (right)
            note_wrong(record, "executed without its number", entry->text);
        return;
    }
    if (!right) {
        if (turns)
            note_altered(record, entry->text);
        else
            note_wrong(record, "not a command of the job", entry->text);
        return;
    }
    bool move = entry->text[0] == 'G' && (entry->text[1] == '0' || entry->text[1] == '1');
    bool here = record->number[index] == entry->number;
    if (move && entry->duration == 0 &&
        (anew || !here)) { /* it was in the planner at a halt or a reset */
        record->next += here && record->next == index;
        return;
    }
    if (!here) {
        record->executed[index]++; /* of a run before, told late */
        record->last_executed += index == record->last_executed;
        return;
    }
    int turn = record->next >= 0 ? record->next : record->last_executed;
    if (index > turn && anew)
        return; /* done at once, ahead of moves that a reset threw away */
    if (record->next < 0)
        record->first = (int)index;
    else if (index != record->next)
        note_wrong(record, "not in its turn", entry->text);
    record->executed[index]++;
    record->next = (int)index + 1;
}

fio_machine *print_machine(print_record *record, const print_job *job, const print_plan *plan) {
    fio_machine_options options = plan->machine;
    memset(record, 0, sizeof *record);
    record->job = job;
    record->first = -1;
    record->verbose = plan->verbose;
    options.log = (fio_execution_log){executed, record};
    if (fio_machine_create(&record->machine, &options) != FIO_OK) {
        fprintf(stderr, "no machine: %s\n", fio_error_message());
        exit(1);
    }
    return record->machine;
}

typedef struct run {
    const print_plan *plan;
    print_result *result;
    print_record *record;
    fio_streamer *streamer;
    double start;
    int acts;
    bool marked;
    fio_stream_resume last_mark;
} run;

static void listen(void *context, const fio_stream_event *event) {
    static const char *const states[] = {"greeting", "running",   "pausing",    "paused",
                                         "resuming", "finishing", "cancelling", "done"};
    run *self = context;
    if (event->kind == FIO_STREAM_SENT && event->number >= 0) {
        char text[256];
        snprintf(text, sizeof text, "%.*s", (int)event->length, event->text);
        const char *key = strrchr(text, 'K');
        long index = key ? strtol(key + 1, NULL, 10) : -1;
        if (index >= 0 && index < PRINT_COMMANDS)
            self->record->number[index] = event->number;
    }
    if (event->kind == FIO_STREAM_MARK) {
        self->last_mark = *event->resume;
        self->marked = true;
    }
    if (event->kind == FIO_STREAM_STATE)
        self->record->ending = event->state == FIO_STREAM_CANCELLING;
    if (event->kind == FIO_STREAM_STATE && event->state == FIO_STREAM_RUNNING)
        self->record->run_resets = self->record->print_resets =
            fio_machine_count(self->record->machine)->resets;
    if (!self->plan->verbose)
        return;
    double time = event->time - self->start;
    if (event->kind == FIO_STREAM_STATE)
        printf("%10.4f -- %s\n", time, states[event->state]);
    else if (event->kind == FIO_STREAM_SENT)
        printf("%10.4f > %.*s\n", time, (int)event->length, event->text);
    else if (event->kind == FIO_STREAM_ANSWER)
        printf("%10.4f <     %.*s\n", time, (int)event->length, event->text);
    else if (event->kind == FIO_STREAM_WARNING)
        printf("%10.4f !! %.*s\n", time, (int)event->length, event->text);
}

static void act(run *self, double now) {
    const print_plan *plan = self->plan;
    self->result->acted = true;
    switch (plan->act) {
    case PRINT_PAUSE:
        if (self->acts == 0)
            fio_streamer_pause(self->streamer, now);
        else
            fio_streamer_resume(self->streamer, now);
        break;
    case PRINT_CANCEL:
        fio_streamer_cancel(self->streamer, now);
        break;
    case PRINT_STOP:
        fio_streamer_emergency(self->streamer, now);
        break;
    case PRINT_KILL:
        self->result->killed = true;
        fio_streamer_lost(self->streamer, now, FIO_LINK_LOST, "killed");
        break;
    default:
        break;
    }
    self->acts++;
}

static void woken(void *context, double now, const struct pollfd *polls, int count) {
    run *self = context;
    const print_plan *plan = self->plan;
    double time = now - self->start;
    (void)polls, (void)count;
    if (++self->result->loops > 3000000 || time > plan->most_seconds) {
        self->result->hung = true;
        fio_streamer_lost(self->streamer, now, FIO_BUG, "hung");
        return;
    }
    if (plan->act != PRINT_NOTHING && self->acts == 0 && time >= plan->act_at)
        act(self, now);
    /* a pause that came too early, or was still under way, is asked for again */
    bool paused = fio_streamer_report(self->streamer)->state == FIO_STREAM_PAUSED;
    if (plan->act == PRINT_PAUSE && self->acts > 0 && paused &&
        time >= plan->act_at + plan->act_for)
        act(self, now);
}

static fio_source_result next(void *context, fio_source_command *command) {
    return fio_source_next(context, command);
}

static fio_status seek(void *context, int64_t index) {
    return fio_source_seek(context, index);
}

void print_run(print_result *result, print_record *record, const print_plan *plan, double start,
               const fio_stream_resume *resume) {
    memset(result, 0, sizeof *result);
    run self = {.plan = plan, .result = result, .record = record, .start = start};
    fio_transport *transport;
    fio_source *source;
    for (int i = 0; i < PRINT_COMMANDS; i++)
        record->number[i] = -1;
    fio_session_hooks hooks = {
        .woken = woken, .period = plan->act == PRINT_NOTHING ? 10 : 0.05, .context = &self};
    if (fio_machine_transport(&transport, record->machine, start, 0) != FIO_OK ||
        fio_source_memory(&source, record->job->text, record->job->length) != FIO_OK) {
        fprintf(stderr, "no run: %s\n", fio_error_message());
        exit(1);
    }
    record->run_resets = fio_machine_count(record->machine)->resets;
    fio_stream_source job = {next, seek, source};
    fio_stream_listener listener = {listen, &self};
    if (fio_streamer_create(&self.streamer, &plan->stream, &job, resume, &listener) != FIO_OK) {
        fprintf(stderr, "no streamer: %s\n", fio_error_message());
        exit(1);
    }
    result->status = fio_session_run(transport, self.streamer, &hooks);
    result->report = *fio_streamer_report(self.streamer);
    snprintf(result->message, sizeof result->message, "%s", result->report.message);
    result->resume = result->report.resume;
    if (result->killed) {
        if (self.marked)
            result->resume = self.last_mark;
        else if (resume)
            result->resume = *resume;
        else {
            result->resume = (fio_stream_resume){.number = -1};
        }
    }
    result->plugged = fio_machine_plugged(record->machine);
    result->seconds = fio_transport_now(transport) - start;
    if (plan->verbose)
        printf("%10.4f == status %d: %s (accepted %lld, made %lld)\n", result->seconds,
               result->status, result->message, (long long)result->resume.accepted,
               (long long)result->resume.made);
    fio_streamer_free(self.streamer);
    fio_source_close(source);
    fio_transport_close(transport);
}
