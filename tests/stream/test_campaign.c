/* Prints with faults in both directions, on a virtual clock: each ends with the job executed, each
 * command once and in order, or says that it did not and where to go on; and from there a second
 * run completes it.
 *
 *     test-stream-campaign [--seed N] [--runs N] [--free] [--verbose] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "print.h"
#include "virtual/machine.h"

enum { RUNS_MOST = 8 };

typedef struct campaign_tally {
    int64_t prints, runs, clean, reset, stopped, cancelled, faults, resends, repeats, undetectable;
    int64_t given_up, failures, commands, overruns, differences;
    int64_t timed_faults;
    double seconds, lost_seconds;
    int worst_repeats;
} campaign_tally;

static bool chance(print_random *random, double probability) {
    return print_random_unit(random) < probability;
}

static double some(print_random *random, double most) {
    return chance(random, 0.4) ? 0 : most * print_random_unit(random);
}

static void plan_faults(fio_machine_faults *faults, print_random *random, bool freely) {
    if (freely) {
        faults->flip_bytes = 0.01 + 0.04 * print_random_unit(random);
        faults->flip_bytes *= 0.1 + 0.9 * print_random_unit(random);
    } else {
        faults->flip_in = some(random, 0.05);
        faults->flip_out = some(random, 0.05);
    }
    faults->lose_ok = some(random, 0.03);
    faults->double_ok = some(random, 0.03);
    faults->late_ok = some(random, 0.02);
    faults->late_seconds = 0.05 + print_random_unit(random);
    faults->split = some(random, 0.5);
    faults->merge = some(random, 0.2);
}

static void plan_window(print_plan *plan, print_random *random) {
    fio_machine_options *machine = &plan->machine;
    static const int64_t rates[] = {115200, 250000, 0};
    machine->rate = rates[print_random_below(random, 3)];
    machine->receive_bytes = 64 << print_random_below(random, 5);
    machine->command_slots = 1 + print_random_below(random, 16);
    machine->advanced_ok = chance(random, 0.4);
    if (chance(random, 0.4)) {
        plan->stream.window_lines = machine->command_slots;
        plan->stream.window_bytes = machine->receive_bytes - 1;
    }
    plan->stream.rate = machine->rate;
}

static const char *plan_script(print_random *random, int commands) {
    static char script[120];
    int line = 5 + print_random_below(random, commands);
    switch (print_random_below(random, 8)) {
    case 0:
        snprintf(script, sizeof script, "at line %d reset", line);
        break;
    case 1:
        snprintf(script, sizeof script,
                 "at line %d halt \"Error:Thermal Runaway, system stopped!\"", line);
        break;
    case 2:
        snprintf(script, sizeof script, "at line %d unplug", line);
        break;
    case 3:
        snprintf(script, sizeof script, "at line %d silent 60", line);
        break;
    case 4:
        snprintf(script, sizeof script, "at byte %d unplug for 3", line * 30);
        break;
    default:
        return NULL;
    }
    return script;
}

static void make_plan(print_plan *plan, print_random *random, bool freely, int commands) {
    memset(plan, 0, sizeof *plan);
    plan->machine = fio_machine_options_defaults();
    plan->stream = fio_stream_options_defaults();
    plan->machine.seed = print_random_next(random);
    plan_window(plan, random);
    plan_faults(&plan->machine.faults, random, freely);
    plan->machine.busy_seconds = chance(random, 0.7) ? 2 : 0;
    plan->machine.emergency_parser = chance(random, 0.5);
    plan->machine.reset_on_dtr = chance(random, 0.5);
    plan->machine.script = plan_script(random, commands);
    plan->most_seconds = 3600;
    if (chance(random, 0.5))
        plan->act = (print_act)(1 + print_random_below(random, 4));
    plan->act_at = 90 * print_random_unit(random);
    plan->act_for = 20 * print_random_unit(random);
}

typedef struct print_check {
    const print_plan *plan;
    const print_record *record;
    uint64_t seed;
    bool freely; /* then the noise may be such that no end can be confirmed */
    bool failed;
} print_check;

static void fail(print_check *check, const char *what, const char *detail) {
    if (!check->failed)
        printf("seed %llu: %s: %s\n", (unsigned long long)check->seed, what, detail);
    check->failed = true;
}

static int64_t missing(const print_record *record) {
    int64_t count = 0;
    for (int i = 0; i < record->job->count; i++)
        count += record->executed[i] == 0;
    return count;
}

static int64_t differences(const print_record *record, int64_t undetectable) {
    return record->wrong > undetectable ? record->wrong - undetectable : 0;
}

/* After a run that did not end well. */
static void check_end(print_check *check, const print_result *result) {
    const fio_machine *machine = check->record->machine;
    fio_state state;
    fio_virtual_printer_state(fio_machine_printer(machine), &state);
    bool hot = state.nozzle_target[0] > 0 || state.bed_target > 0;
    bool silent = check->plan->machine.script && strstr(check->plan->machine.script, "silent");
    if (result->report.heaters_off && hot)
        fail(check, "the heaters are said to be off, but are on", result->message);
    bool before = result->status == FIO_NO_PRINTER; /* it never answered */
    if (hot && !check->freely && result->plugged && !silent && !result->killed && !before)
        fail(check, "the heaters were left on", result->message);
    if (result->status == FIO_OK || !result->message[0])
        fail(check, "no reason is told", "");
}

static void revive(fio_machine *machine, double now) {
    fio_machine_advance(machine, now);
    if (!fio_machine_plugged(machine))
        fio_machine_plug(machine, now);
    if (machine->processor == FIO_HALTED)
        fio_firmware_reset(machine); /* somebody switches it off and on */
}

/* Where the second run begins: after all that was executed if the printer lived on, else at most
 * what the planner, the window and the lines behind the last marker hold before that. */
static void check_resume(print_check *check, campaign_tally *tally, int executed, bool was_reset,
                         int first) {
    char detail[120];
    int window = check->plan->machine.command_slots + check->plan->machine.receive_bytes / 12;
    int most = 4 * 16 + window + 24 + 8;
    snprintf(detail, sizeof detail, "%d executed, goes on with %d%s", executed, first,
             was_reset ? " after a reset" : "");
    if (first > executed)
        fail(check, "a gap", detail);
    if (!was_reset && first < executed)
        fail(check, "repeated without need", detail);
    if (executed - first > most && !check->record->job->tiny)
        fail(check, "too much repeated", detail);
    if (executed - first > tally->worst_repeats)
        tally->worst_repeats = executed - first;
}

static int first_missing(const print_record *record) {
    int index = 0;
    while (index < record->job->count && record->executed[index] > 0)
        index++;
    return index;
}

/* What the faults cost: the same print once more, on a perfect link. */
static void check_time(print_check *check, campaign_tally *tally, print_plan plan,
                       const print_job *job, double seconds) {
    static print_record record;
    print_result result;
    double late = plan.machine.faults.late_seconds;
    int64_t faults = fio_machine_count(check->record->machine)->faults;
    plan.machine.faults = (fio_machine_faults){0};
    plan.verbose = false;
    fio_machine *machine = print_machine(&record, job, &plan);
    print_run(&result, &record, &plan, 0, NULL);
    if (result.status != FIO_OK || record.wrong > 0)
        fail(check, "a perfect link is not enough", result.message);
    double lost = seconds - result.seconds;
    char detail[80];
    snprintf(detail, sizeof detail, "%.1f s for %lld faults", lost, (long long)faults);
    if (lost > 5 + late + 0.7 * (double)faults)
        fail(check, "too slow to recover", detail);
    tally->timed_faults += faults;
    tally->lost_seconds += lost;
    fio_machine_free(machine);
}

static void describe(const print_check *check) {
    const print_plan *plan = check->plan;
    printf("seed %llu: rate %lld, receive %d, slots %d, advanced %d, window %d/%d, busy %g, "
           "parser %d, dtr %d, script %s, act %d at %g\n",
           (unsigned long long)check->seed, (long long)plan->machine.rate,
           plan->machine.receive_bytes, plan->machine.command_slots, plan->machine.advanced_ok,
           plan->stream.window_lines, plan->stream.window_bytes, plan->machine.busy_seconds,
           plan->machine.emergency_parser, plan->machine.reset_on_dtr,
           plan->machine.script ? plan->machine.script : "-", plan->act, plan->act_at);
}

/* The whole print, of `runs` + 1 runs. */
static void judge(print_check *check, campaign_tally *tally, const print_job *job,
                  const print_result *result, int runs, const fio_machine_counts *counts) {
    const print_plan *plan = check->plan;
    const print_record *record = check->record;
    if (result->status != FIO_OK && check->freely)
        tally->given_up++;
    else if (result->status != FIO_OK)
        fail(check, "not completed in many runs", result->message);
    else if (first_missing(record) < job->count && missing(record) > counts->undetectable)
        fail(check, "said to be done, but not all was executed",
             job->commands[first_missing(record)]);
    for (int i = 0; i < job->count && runs == 0 && !check->freely; i++)
        if (record->executed[i] > 1)
            fail(check, "executed twice", job->commands[i]);
    if (runs == 0 && result->status == FIO_OK && plan->act == PRINT_NOTHING && !check->freely &&
        !plan->machine.script)
        check_time(check, tally, *plan, job, result->seconds);
    if (differences(record, counts->undetectable) > 0)
        fail(check, "executed otherwise", record->first_wrong);
    if (record->wrong > 0 && !check->freely && !check->failed)
        printf("seed %llu: damage that no checksum tells: %s\n", (unsigned long long)check->seed,
               record->first_wrong);
    tally->differences += record->wrong;
    tally->prints++;
    tally->clean += runs == 0;
    tally->faults += counts->faults;
    tally->undetectable += counts->undetectable;
    tally->overruns += counts->overruns;
    tally->commands += job->count;
    tally->failures += check->failed;
}

static bool run_print(uint64_t seed, bool freely, bool verbose, campaign_tally *tally) {
    static print_job job;
    static print_record record;
    print_random random = {seed * 0x9e3779b97f4a7c15u + (freely ? 77 : 0)};
    print_plan plan;
    print_result result;
    int moves = 60 + print_random_below(&random, 240);
    print_job_make(&job, print_random_next(&random), moves);
    make_plan(&plan, &random, freely, job.count);
    plan.verbose = verbose;
    print_check check = {&plan, &record, seed, freely, false};
    if (verbose)
        describe(&check);
    fio_machine *machine = print_machine(&record, &job, &plan);
    fio_stream_resume from = {.number = -1};
    bool anew = false;
    bool has_from = false;
    double now = 0;
    int runs = 0;
    for (; runs < RUNS_MOST; runs++) {
        record.first = -1;
        if (runs > 0)
            revive(machine, now);
        print_run(&result, &record, &plan, now, has_from ? &from : NULL);
        anew = anew || from.number < 0;
        if (runs > 0 && record.first >= 0 && !freely)
            check_resume(&check, tally, record.last_executed,
                         anew || fio_machine_count(machine)->resets > record.resets,
                         /* while it printed */ record.first);
        tally->runs++;
        tally->resends += result.report.resends;
        tally->repeats += result.report.repeats;
        tally->seconds += result.seconds;
        now += result.seconds;
        if (result.hung && !freely) { /* a damaged line may have told it to wait for a person */
            fail(&check, "hung", result.message);
            break;
        }
        if (result.status == FIO_OK)
            break;
        check_end(&check, &result);
        tally->stopped++;
        now += 150; /* what it has got is made */
        fio_machine_advance(machine, now);
        int executed = record.next >= 0 ? record.next : record.last_executed;
        if (result.killed && result.resume.accepted == 0 && result.resume.number < 0)
            has_from = false;
        else
            has_from = true;
        from = result.resume;
        if (from.made > executed && !freely)
            fail(&check, "more is said to be made than is", result.message);
        if (from.accepted > job.count || from.made > from.accepted || from.sent < from.accepted)
            fail(&check, "the resume point makes no sense", result.message);
        plan.act = PRINT_NOTHING;
        record.next = -1; /* the next run tells by its first command where it goes on */
        record.last_executed = executed;
        if (record.first >= 0 || runs == 0)
            anew = false;
        if (record.first >= 0 || runs == 0)
            record.resets = record.print_resets;
    }
    judge(&check, tally, &job, &result, runs, fio_machine_count(machine));
    fio_machine_free(machine);
    print_job_free(&job);
    return !check.failed;
}

int main(int count, char **arguments) {
    uint64_t seed = 1;
    int runs = 250, index = 1;
    bool freely = false, verbose = false;
    for (; index < count; index++) {
        if (!strcmp(arguments[index], "--seed") && index + 1 < count)
            seed = strtoull(arguments[++index], NULL, 10);
        else if (!strcmp(arguments[index], "--runs") && index + 1 < count)
            runs = atoi(arguments[++index]);
        else if (!strcmp(arguments[index], "--free"))
            freely = true;
        else if (!strcmp(arguments[index], "--verbose"))
            verbose = true;
        else {
            fprintf(stderr, "usage: %s [--seed N] [--runs N] [--free] [--verbose]\n", arguments[0]);
            return 2;
        }
    }
    campaign_tally all = {0};
    for (int i = 0; i < runs; i++)
        run_print(seed + (uint64_t)i, freely, verbose, &all);
    printf(
        "%lld prints, %lld runs, %lld in one run, %lld stopped; %lld commands, %lld faults, "
        "%lld resends, %lld lines repeated, %lld bytes overrun, %lld undetectable, "
        "%lld differences, at most %d commands printed again, %.0f s of virtual time, %.1f s lost "
        "to %lld faults; %lld failed\n",
        (long long)all.prints, (long long)all.runs, (long long)all.clean, (long long)all.stopped,
        (long long)all.commands, (long long)all.faults, (long long)all.resends,
        (long long)all.repeats, (long long)all.overruns, (long long)all.undetectable,
        (long long)all.differences, all.worst_repeats, all.seconds, all.lost_seconds,
        (long long)all.timed_faults, (long long)all.failures);
    return all.failures > 0 || all.prints == 0;
}
