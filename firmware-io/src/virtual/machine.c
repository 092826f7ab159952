/* Making a machine, its serial line, and its time. */
#include "virtual/machine.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

#define FINISHING_TURNS 120000 /* what is not done by then is never done */
#define MERGE_SECONDS 0.016    /* FTDI's latency timer, as it is set from the factory */
#define BITS_PER_BYTE 10       /* a start bit, eight, a stop bit */

fio_machine_options fio_machine_options_defaults(void) {
    return (fio_machine_options){
        .printer = fio_virtual_options_defaults(),
        .rate = 115200,
        .receive_bytes = 128,
        .command_slots = 4,
        .line_seconds = 0.0003,
        .busy_seconds = 2,
        .boot_seconds = 1,
        .reset_on_dtr = true,
        .emergency_parser = true,
        .firmware = "marlin",
        .faults = {.late_seconds = 1},
    };
}

static bool is_chance(double value) {
    return value >= 0 && value <= 1;
}

static fio_status check_options(const fio_machine_options *options) {
    if (options->rate != 0 && (options->rate < 300 || options->rate > 100000000))
        return fio_fail(FIO_USAGE, "a rate of %lld bits/s: 0 or 300 to 100000000",
                        (long long)options->rate);
    if (options->receive_bytes < 16 || options->receive_bytes > FIO_RECEIVE_MOST)
        return fio_fail(FIO_USAGE, "a receive buffer of %d bytes: 16 to %d", options->receive_bytes,
                        FIO_RECEIVE_MOST);
    if (options->command_slots < 1 || options->command_slots > FIO_SLOTS_MOST)
        return fio_fail(FIO_USAGE, "%d commands in the queue: 1 to %d", options->command_slots,
                        FIO_SLOTS_MOST);
    if (!fio_dialect_find(options->firmware))
        return fio_fail(FIO_USAGE,
                        "no firmware \"%s\": marlin, prusa, repetier, klipper, grbl, smoothie and "
                        "reprapfirmware are known",
                        options->firmware ? options->firmware : "");
    const double seconds[] = {options->line_seconds, options->busy_seconds, options->boot_seconds,
                              options->faults.late_seconds};
    for (size_t i = 0; i < sizeof seconds / sizeof *seconds; i++)
        if (!(seconds[i] >= 0 && seconds[i] <= 1e6))
            return fio_fail(FIO_USAGE, "times of a machine are 0 to 1e6 s");
    const fio_machine_faults *faults = &options->faults;
    const double chances[] = {faults->flip_in, faults->flip_out,  faults->flip_bytes,
                              faults->lose_ok, faults->double_ok, faults->late_ok,
                              faults->split,   faults->merge,     faults->lose_bytes_in};
    for (size_t i = 0; i < sizeof chances / sizeof *chances; i++)
        if (!is_chance(chances[i]))
            return fio_fail(FIO_USAGE, "a fault's probability is 0 to 1, not %g", chances[i]);
    return FIO_OK;
}

fio_status fio_machine_create(fio_machine **machine, const fio_machine_options *options) {
    fio_machine_options defaults = fio_machine_options_defaults();
    *machine = NULL;
    if (!options)
        options = &defaults;
    fio_status status = check_options(options);
    if (status != FIO_OK)
        return status;
    fio_machine *made = fio_allocate(sizeof *made);
    if (!made)
        return fio_fail(FIO_NO_MEMORY, "no memory for a machine (%zu bytes)", sizeof *made);
    status = fio_virtual_printer_create(&made->printer, &options->printer, &options->log);
    if (status != FIO_OK) {
        fio_release(made);
        return status;
    }
    made->options = *options;
    made->options.script = NULL; /* the caller's text need not stay */
    made->plan.plug_at = INFINITY;
    status = fio_script_read(&made->script, options->script ? options->script : "");
    if (status != FIO_OK) {
        fio_machine_free(made);
        return status;
    }
    made->random.state = options->seed;
    made->reading.state = ~options->seed;
    made->plugged = true;
    made->in.byte_seconds = made->out.byte_seconds =
        options->rate ? (double)BITS_PER_BYTE / (double)options->rate : 0;
    fio_printer_live(made->printer, 0);
    made->printer->firmware = fio_firmware_command;
    made->printer->firmware_context = made;
    made->dialect = fio_dialect_find(options->firmware);
    made->busy_seconds = made->dialect->busy ? options->busy_seconds : 0;
    made->printer->unknown = made->dialect->unknown;
    made->idle_at = made->dialect->wait_seconds;
    made->processor = FIO_IDLE;
    made->damage_at = made->lose_at = -1;
    made->taint_at = INT32_MAX;
    made->card.open = -1;
    made->transfer.deadline = INFINITY;
    fio_firmware_keep_defaults(made);
    *machine = made;
    return FIO_OK;
}

void fio_machine_free(fio_machine *machine) {
    if (machine)
        fio_virtual_printer_free(machine->printer);
    fio_release(machine);
}

/* Bytes arrive one by one, each at its time, until `limit`, or until one of them ends a line: then
 * there may be something to do before the next. */
static bool deliver(fio_machine *machine, double limit) {
    fio_wire *in = &machine->in;
    while (fio_wire_next(in) <= limit) {
        if (!in->byte_seconds && !fio_firmware_may_receive(machine))
            return false;
        if (in->next > machine->now)
            machine->now = in->next;
        uint8_t byte = fio_wire_at(in, in->arrived);
        fio_wire_arrive(in);
        in->first = in->arrived;
        fio_fault_byte(machine, byte);
        unsigned unread = machine->received_last - machine->received_first;
        if (byte == '\n' || byte == '\r' || unread > (unsigned)machine->options.receive_bytes / 2)
            return true;
    }
    return false;
}

/* What has left the firmware arrives at the host; sometimes it is kept to be put together with what
 * comes after it, as the latency timers of serial bridges do. */
static void arrive(fio_machine *machine) {
    fio_wire *out = &machine->out;
    bool empty = fio_wire_readable(out) == 0;
    while (fio_wire_next(out) <= machine->now)
        fio_wire_arrive(out);
    if (empty && fio_wire_readable(out) > 0 &&
        fio_random_chance(&machine->reading, machine->options.faults.merge))
        machine->merged_until = machine->now + MERGE_SECONDS;
}

void fio_machine_advance(fio_machine *machine, double now) {
    if (!(now > machine->now && now < INFINITY)) /* also of a time that is none */
        now = machine->now;
    for (;;) {
        fio_firmware_step(machine);
        double due = fio_firmware_next(machine);
        if (deliver(machine, due < now ? due : now))
            continue;
        if (!(due <= now))
            break;
        if (due > machine->now)
            machine->now = due;
        fio_printer_advance(machine->printer, machine->now);
    }
    machine->now = now;
    fio_printer_advance(machine->printer, now);
    machine->counts.starved = machine->printer->starved;
    arrive(machine);
}

double fio_machine_next(const fio_machine *machine) {
    if (fio_machine_readable(machine))
        return machine->now;
    double next = fmin(fio_firmware_next(machine), fio_wire_line(&machine->out));
    if (fio_wire_readable(&machine->out) > 0)
        next = fmin(next, machine->merged_until);
    if (machine->in.byte_seconds || fio_firmware_may_receive(machine))
        next = fmin(next, fio_wire_line(&machine->in));
    return fmax(next, machine->now);
}

static size_t line_capacity(const fio_machine *machine) {
    return machine->in.byte_seconds ? FIO_MACHINE_LINE_BYTES : FIO_MACHINE_PACKET_BYTES;
}

size_t fio_machine_room(const fio_machine *machine) {
    size_t waiting = fio_wire_waiting(&machine->in), most = line_capacity(machine);
    return machine->plugged && waiting < most ? most - waiting : 0;
}

size_t fio_machine_write(fio_machine *machine, double now, const void *bytes, size_t size) {
    fio_machine_advance(machine, now);
    size_t taken = 0;
    while (taken < size) {
        size_t room = fio_machine_room(machine);
        room = room < size - taken ? room : size - taken;
        if (room == 0)
            break;
        for (size_t i = 0; i < room; i++)
            fio_wire_put(&machine->in, machine->now, ((const uint8_t *)bytes)[taken + i]);
        taken += room;
        fio_machine_advance(machine, machine->now);
    }
    machine->counts.bytes_in += (int64_t)taken;
    return taken;
}

bool fio_machine_readable(const fio_machine *machine) {
    return fio_wire_readable(&machine->out) > 0 && machine->now >= machine->merged_until;
}

size_t fio_machine_read(fio_machine *machine, double now, void *bytes, size_t capacity) {
    fio_machine_advance(machine, now);
    if (!fio_machine_readable(machine))
        return 0;
    fio_wire *out = &machine->out;
    size_t count = fio_wire_readable(out);
    count = count < capacity ? count : capacity;
    machine->splitting = count > 1 && !machine->splitting &&
                         fio_random_chance(&machine->reading, machine->options.faults.split);
    if (machine->splitting)
        count = 1 + (size_t)fio_random_below(&machine->reading, (int)count - 1);
    for (size_t i = 0; i < count; i++)
        ((uint8_t *)bytes)[i] = fio_wire_at(out, out->first++);
    machine->counts.bytes_out += (int64_t)count;
    return count;
}

size_t fio_machine_pending(const fio_machine *machine) {
    return fio_wire_waiting(&machine->in);
}

static size_t lose_waiting(fio_machine *machine) {
    const fio_wire *in = &machine->in;
    for (unsigned i = in->arrived; i != in->last; i++)
        fio_firmware_lose(machine, fio_wire_at(in, i));
    return fio_wire_discard(&machine->in, machine->now);
}

size_t fio_machine_discard(fio_machine *machine, double now) {
    fio_machine_advance(machine, now);
    return lose_waiting(machine);
}

void fio_machine_set_lines(fio_machine *machine, double now, bool dtr, bool rts) {
    fio_machine_advance(machine, now);
    bool rises = dtr && !machine->dtr;
    machine->dtr = dtr;
    machine->rts = rts;
    if (rises && machine->options.reset_on_dtr)
        fio_firmware_reset(machine);
}

void fio_machine_set_rate(fio_machine *machine, double now, int64_t rate) {
    fio_machine_advance(machine, now);
    machine->host_rate = rate;
}

/* It has something to do that ends of itself. */
static bool will_go_on(const fio_machine *machine) {
    const fio_virtual_printer *printer = machine->printer;
    if (machine->processor == FIO_HALTED || (printer->waiting && isinf(printer->wait_end)))
        return fio_printer_next(printer) < INFINITY;
    return machine->processor == FIO_BOOTING || machine->queued > 0 ||
           fio_printer_next(printer) < INFINITY;
}

bool fio_machine_working(const fio_machine *machine) {
    if (machine->processor == FIO_HALTED)
        return fio_wire_waiting(&machine->out) > 0;
    return fio_wire_waiting(&machine->in) > 0 || fio_wire_waiting(&machine->out) > 0 ||
           machine->processor != FIO_IDLE || machine->queued > 0 || machine->held > 0 ||
           fio_wire_readable(&machine->out) > 0 || fio_printer_next(machine->printer) < INFINITY;
}

bool fio_machine_plugged(const fio_machine *machine) {
    return machine->plugged;
}

void fio_machine_unplug(fio_machine *machine) {
    machine->plugged = machine->dtr = machine->rts = false;
    lose_waiting(machine);
    machine->held = 0;
    fio_wire_discard(&machine->out, machine->now); /* what has arrived may still be read */
    machine->merged_until = machine->now;
}

void fio_machine_plug_in(fio_machine *machine) {
    if (machine->plugged)
        return;
    machine->plugged = true;
    machine->out.first = machine->out.arrived;
}

void fio_machine_plug(fio_machine *machine, double now) {
    fio_machine_advance(machine, now);
    fio_machine_plug_in(machine);
}

fio_status fio_machine_finish(fio_machine *machine) {
    fio_virtual_printer *printer = machine->printer;
    machine->busy_seconds = machine->temperature_seconds = 0; /* nobody listens any more */
    machine->position_seconds = machine->card_seconds = 0;
    for (int turns = 0; turns < FINISHING_TURNS && will_go_on(machine); turns++) {
        double next = fmin(fio_firmware_next(machine), fio_printer_next(printer));
        if (!(next < INFINITY))
            break;
        fio_machine_advance(machine, next);
        if (fio_wire_readable(&machine->out) > FIO_WIRE_BYTES / 4)
            machine->out.first = machine->out.arrived; /* nobody reads that any more */
    }
    if (printer->waiting)
        fio_printer_end_wait(printer);
    if (printer->open)
        fio_printer_end_entry(printer);
    return fio_virtual_printer_finish(printer);
}

const fio_virtual_printer *fio_machine_printer(const fio_machine *machine) {
    return machine->printer;
}

const fio_machine_counts *fio_machine_count(const fio_machine *machine) {
    return &machine->counts;
}
