/* What the line does to the bytes. */
#include <string.h>

#include "virtual/machine.h"

static uint8_t flipped(fio_machine *machine, uint8_t byte) {
    machine->counts.faults++;
    return byte ^ (uint8_t)(1 << fio_random_below(&machine->random, 8));
}

/* Each bit by itself, so that a byte is damaged with this probability; never unchanged. */
static uint8_t scrambled(fio_machine *machine, uint8_t byte) {
    machine->counts.faults++;
    return byte ^ (uint8_t)(1 + fio_random_below(&machine->random, 255));
}

/* Ten bits are sampled right while the two clocks differ by less than 4 %: bridges that divide a
 * clock of theirs hit few rates exactly. */
static bool wrong_rate(const fio_machine *machine) {
    int64_t rate = machine->options.rate, host = machine->host_rate;
    int64_t difference = host > rate ? host - rate : rate - host;
    return rate && host && difference > rate / 25;
}

/* A line's one flipped bit is somewhere in it: drawn when it begins, by the length of the line
 * before, at the latest in its end. */
static void begin_line(fio_machine *machine) {
    const fio_machine_faults *faults = &machine->options.faults;
    int length = machine->last_line_length > 0 ? machine->last_line_length : 16;
    machine->damage_at = machine->lose_at = -1;
    bool flips = fio_random_chance(&machine->random, faults->flip_in);
    if (machine->plan.flip_lines > 0) {
        machine->plan.flip_lines--;
        flips = true;
    }
    if (flips)
        machine->damage_at = fio_random_below(&machine->random, length);
    bool loses = fio_random_chance(&machine->random, faults->lose_bytes_in);
    if (machine->plan.cut_lines > 0) {
        machine->plan.cut_lines--;
        loses = true;
    }
    if (loses) {
        machine->lose_at = fio_random_below(&machine->random, length);
        machine->lose_count = 1 + fio_random_below(&machine->random, 8);
        machine->counts.faults++;
    }
}

void fio_fault_byte(fio_machine *machine, uint8_t byte) {
    const fio_machine_faults *faults = &machine->options.faults;
    bool end = byte == '\n', lost = false;
    uint8_t arrived = byte;
    fio_script_happens(machine, FIO_AT_BYTE, (double)++machine->bytes_arrived);
    if (!machine->plugged) {
        fio_firmware_lose(machine, byte);
        return;
    }
    if (machine->line_length == 0)
        begin_line(machine);
    int at = machine->line_length++;
    if (machine->damage_at >= 0 && (at == machine->damage_at || end)) {
        arrived = flipped(machine, arrived);
        machine->damage_at = -1;
    }
    if (fio_random_chance(&machine->random, faults->flip_bytes))
        arrived = scrambled(machine, arrived);
    if (wrong_rate(machine))
        arrived = (uint8_t)fio_random_next(&machine->random);
    if (machine->lose_at >= 0 && (at >= machine->lose_at || end)) {
        lost = true;
        if (--machine->lose_count == 0)
            machine->lose_at = -1;
    }
    if (end) {
        machine->last_line_length = machine->line_length;
        machine->line_length = 0;
    }
    if (lost)
        fio_firmware_lose(machine, byte);
    else
        fio_firmware_receive(machine, arrived, arrived != byte);
}

static void put(fio_machine *machine, uint8_t byte) {
    bool heard = machine->plugged && (machine->dtr || !machine->options.mute_without_dtr);
    if (!heard || fio_wire_room(&machine->out) == 0)
        return;
    if (wrong_rate(machine))
        byte = (uint8_t)fio_random_next(&machine->random);
    fio_wire_put(&machine->out, machine->now, byte);
}

static void put_line(fio_machine *machine, const char *text, size_t length) {
    const fio_machine_faults *faults = &machine->options.faults;
    size_t flip = SIZE_MAX;
    if (fio_random_chance(&machine->random, faults->flip_out))
        flip = (size_t)fio_random_below(&machine->random, (int)length + 1);
    for (size_t i = 0; i <= length; i++) {
        uint8_t byte = i < length ? (uint8_t)text[i] : '\n';
        if (i == flip)
            byte = flipped(machine, byte);
        if (fio_random_chance(&machine->random, faults->flip_bytes))
            byte = scrambled(machine, byte);
        put(machine, byte);
    }
}

/* True if something befalls it: by chance, or because the script has ordered some of these. */
static bool befalls(fio_machine *machine, double chance, double *ordered) {
    bool hit = fio_random_chance(&machine->random, chance);
    if (*ordered > 0) {
        --*ordered;
        hit = true;
    }
    machine->counts.faults += hit;
    return hit;
}

static bool is_late(fio_machine *machine, const char *text, size_t length) {
    fio_plan *plan = &machine->plan;
    bool ordered = plan->late_oks > 0;
    double seconds = ordered ? plan->late_seconds : machine->options.faults.late_seconds;
    return befalls(machine, machine->options.faults.late_ok, &plan->late_oks) &&
           fio_fault_hold(machine, text, length, seconds);
}

void fio_fault_answer(fio_machine *machine, const char *text, size_t length, bool ok) {
    const fio_machine_faults *faults = &machine->options.faults;
    fio_plan *plan = &machine->plan;
    if (ok) {
        fio_script_happens(machine, FIO_AT_OK, (double)machine->counts.oks);
        if (plan->reset || plan->halt)
            return; /* it came too late for this ok */
    }
    if (machine->now < plan->mute_until || befalls(machine, 0, &plan->lose_answers))
        return;
    if (ok &&
        (befalls(machine, faults->lose_ok, &plan->lose_oks) || is_late(machine, text, length)))
        return;
    put_line(machine, text, length);
    if (ok && befalls(machine, faults->double_ok, &plan->double_oks))
        put_line(machine, text, length);
}

/* Late answers are kept in order of the time they are due. */
bool fio_fault_hold(fio_machine *machine, const char *text, size_t length, double seconds) {
    if (machine->held == FIO_HELD_MOST || length >= sizeof machine->late[0].text)
        return false;
    fio_late *late = &machine->late[machine->held++];
    late->at = machine->now + seconds;
    late->length = length;
    memcpy(late->text, text, length);
    return true;
}

double fio_fault_next(const fio_machine *machine) {
    return machine->held ? machine->late[0].at : INFINITY;
}

void fio_fault_release(fio_machine *machine) {
    while (machine->held > 0 && machine->late[0].at <= machine->now) {
        put_line(machine, machine->late[0].text, machine->late[0].length);
        memmove(machine->late, machine->late + 1, (size_t)--machine->held * sizeof *machine->late);
    }
}
