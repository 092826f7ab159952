/* The firmware's main loop: executes the commands of its queue one after the other. */
#include <math.h>
#include <string.h>

#include "virtual/machine.h"

/* Of answers that wait to leave: the processor goes on once there are fewer, as with a full
 * transmit buffer. What has to be read by the host itself may be more. */
#define WIRE_BACKLOG 128
#define USB_BACKLOG 4096

#define HEATING_REPORT_SECONDS 1

void fio_firmware_reset(fio_machine *machine) {
    fio_printer_reset(machine->printer);
    fio_firmware_load_settings(machine);
    machine->card.saving = machine->card.printing = false;
    machine->card.open = -1;
    machine->card_seconds = 0;
    machine->transfer = (fio_transfer){.deadline = INFINITY};
    machine->counts.resets++;
    machine->received_first = machine->received_last;
    machine->reader = (fio_reader){0};
    machine->unpacker = (fio_unpacker){0};
    machine->lost_before = machine->lost_before || machine->mid_line;
    machine->mid_line = false;
    machine->held = 0;
    machine->pending = FIO_EMERGENCY_NONE;
    machine->line_tainted = false;
    machine->taint_at = INT32_MAX;
    machine->emergency = (fio_emergency_parser){0};
    machine->queued = 0;
    machine->busy_seconds = machine->dialect->busy ? machine->options.busy_seconds : 0;
    machine->temperature_seconds = machine->position_seconds = 0;
    machine->prompting = false;
    machine->processor = FIO_BOOTING;
    machine->until = machine->now + (machine->quick_reset ? 0 : machine->options.boot_seconds);
    machine->quick_reset = false;
    fio_wire_discard(&machine->out, machine->now);
}

void fio_firmware_emergency(fio_machine *machine, fio_emergency what) {
    fio_virtual_printer *printer = machine->printer;
    switch (what) {
    case FIO_EMERGENCY_KILL:
        if (machine->dialect->capabilities)
            fio_firmware_say(machine, "echo:M112 Shutdown");
        fio_firmware_kill(machine, NULL);
        break;
    case FIO_EMERGENCY_STOP:
        fio_printer_advance(printer, machine->now);
        fio_printer_stop(printer);
        printer->arc.next = printer->arc.chords + 1;
        break;
    case FIO_EMERGENCY_BREAK:
    case FIO_EMERGENCY_ANSWER:
        if (machine->processor == FIO_WAITING && (printer->wait_user || printer->wait_heater))
            printer->wait_end = fmin(printer->wait_end, machine->now);
        break;
    default:
        break;
    }
}

void fio_firmware_kill(fio_machine *machine, const char *error) {
    fio_virtual_printer *printer = machine->printer;
    fio_printer_advance(printer, machine->now);
    if (printer->waiting)
        fio_printer_end_wait(printer);
    if (printer->open)
        fio_printer_end_entry(printer);
    printer->line_codes = 0;
    fio_printer_halt(printer, error ? error : "emergency stop (M112)");
    if (error)
        fio_firmware_say(machine, error);
    fio_firmware_say_lines(machine, machine->dialect->killed);
    machine->processor = FIO_HALTED;
    machine->queued = 0;
    machine->card.printing = machine->card.saving = false;
}

/* A wait for a person asks the host to ask. */
static void prompt(fio_machine *machine) {
    machine->prompting = machine->printer->wait_user && isinf(machine->printer->wait_end);
    if (!machine->prompting)
        return;
    fio_firmware_say(machine, machine->line.code == 600
                                  ? "//action:prompt_begin Nozzle Parked"
                                  : "//action:prompt_begin M0/1 Break Called");
    fio_firmware_say(machine, "//action:prompt_button Continue");
    fio_firmware_say(machine, "//action:prompt_show");
}

static void begin(fio_machine *machine) {
    fio_virtual_printer *printer = machine->printer;
    fio_queued *queued = &machine->queue[machine->oldest];
    printer->arc.next = printer->arc.chords + 1;
    machine->answered = machine->plan.ok_first && !queued->silent;
    if (machine->answered)
        fio_firmware_ok(machine);
    fio_printer_next_line(printer, fio_firmware_reply, machine);
    int64_t unknown = printer->statistics.unknown_commands;
    fio_printer_begin(printer, &machine->line, queued->cut);
    bool known = printer->statistics.unknown_commands == unknown;
    if (queued->tainted && (known || machine->line.has_number))
        machine->counts.undetectable++;
    if (printer->halted) {
        fio_printer_end_entry(printer);
        machine->processor = FIO_HALTED;
        machine->queued = 0;
        machine->card.printing = machine->card.saving = false;
    } else if (printer->waiting) {
        machine->processor = FIO_WAITING;
        prompt(machine);
    } else
        machine->processor = FIO_CHORDS;
    machine->wait_report_at = machine->now + HEATING_REPORT_SECONDS;
}

/* The oldest command is done: say so, and forget it. */
static void answer(fio_machine *machine, bool answered) {
    if (!machine->queue[machine->oldest].silent && !answered)
        fio_firmware_ok(machine);
    machine->oldest = (machine->oldest + 1) % machine->options.command_slots;
    machine->queued--;
    machine->processor = FIO_IDLE;
}

static void finish(fio_machine *machine) {
    fio_printer_end_entry(machine->printer);
    answer(machine, machine->printer->answered || machine->answered);
}

static void boot(fio_machine *machine) {
    fio_firmware_say_lines(machine, machine->dialect->banner);
    machine->processor = FIO_IDLE;
    machine->idle_at = machine->now + machine->dialect->wait_seconds;
}

static unsigned backlog(const fio_machine *machine, unsigned *most) {
    bool wire = machine->out.byte_seconds > 0;
    *most = wire ? WIRE_BACKLOG : USB_BACKLOG;
    unsigned waiting = fio_wire_waiting(&machine->out);
    if (!wire)
        return fio_wire_readable(&machine->out);
    double left = (machine->now - machine->out.next) / machine->out.byte_seconds + 1;
    unsigned gone = left > 0 ? left < waiting ? (unsigned)left : waiting : 0;
    return waiting - gone;
}

/* One transition of the processor; false if there is none now. */
static bool turn(fio_machine *machine) {
    fio_virtual_printer *printer = machine->printer;
    unsigned most;
    fio_script_pass(machine);
    if (machine->now < machine->plan.silent_until)
        return false;
    switch (machine->processor) {
    case FIO_BOOTING:
        if (machine->now < machine->until)
            return false;
        boot(machine);
        return true;
    case FIO_IDLE:
        fio_firmware_read(machine);
        if (machine->processor != FIO_IDLE || machine->queued == 0 ||
            machine->now < machine->plan.busy_until || backlog(machine, &most) > most)
            return false;
        machine->processor = FIO_WORKING;
        machine->until = machine->now + machine->options.line_seconds + machine->plan.throttle;
        return true;
    case FIO_WORKING:
        if (machine->now < machine->until)
            return false;
        fio_line_read(&machine->line, machine->queue[machine->oldest].text,
                      machine->queue[machine->oldest].length, machine->options.case_insensitive);
        machine->busy_at = machine->now + machine->busy_seconds;
        machine->processor = FIO_BLOCKED;
        fio_script_command(machine, machine->line.text);
        if (machine->plan.reset || machine->plan.halt)
            return true;
        if (machine->card.saving && !machine->transfer.on &&
            !machine->queue[machine->oldest].from_card) {
            fio_firmware_save_line(machine, &machine->line);
            answer(machine, false);
        } else if (!machine->dialect->identity
                       ? fio_firmware_dollar(machine, machine->queue[machine->oldest].text)
                       : machine->dialect->ok_last &&
                             fio_firmware_macro(machine, machine->queue[machine->oldest].text))
            answer(machine, true);
        return true;
    case FIO_BLOCKED:
        fio_firmware_read(machine);
        if (machine->processor != FIO_BLOCKED || !fio_printer_ready(printer, &machine->line))
            return false;
        begin(machine);
        return true;
    case FIO_CHORDS:
        fio_firmware_read(machine);
        if (machine->processor != FIO_CHORDS)
            return false;
        if (printer->arc.next <= printer->arc.chords) {
            if (fio_printer_moves_free(printer) == 0)
                return false;
            fio_printer_next_chord(printer);
        } else
            finish(machine);
        return true;
    case FIO_WAITING:
        fio_firmware_read(machine);
        if (machine->processor != FIO_WAITING || machine->now < printer->wait_end)
            return false;
        fio_printer_end_wait(printer);
        if (machine->prompting)
            fio_firmware_say(machine, "//action:prompt_end");
        machine->prompting = false;
        machine->processor = FIO_CHORDS;
        return true;
    default:
        machine->received_first = machine->received_last;
        return false;
    }
}

static bool works_long(const fio_machine *machine) {
    return machine->processor == FIO_BLOCKED || machine->processor == FIO_CHORDS ||
           machine->processor == FIO_WAITING || machine->now < machine->plan.busy_until;
}

static void say_busy(fio_machine *machine) {
    if (!works_long(machine) || machine->busy_seconds == 0 || machine->now < machine->busy_at)
        return;
    bool user = machine->processor == FIO_WAITING && machine->printer->wait_user;
    char bytes[64];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, machine->dialect->busy);
    fio_text_string(&text, user ? "paused for user" : "processing");
    fio_firmware_say(machine, bytes);
    machine->busy_at = machine->now + machine->busy_seconds;
}

/* Repetier's way of asking for lines. */
static void say_wait(fio_machine *machine) {
    double seconds = machine->dialect->wait_seconds;
    if (seconds == 0)
        return;
    if (machine->processor != FIO_IDLE || machine->queued > 0)
        machine->idle_at = machine->now + seconds;
    else if (machine->now >= machine->idle_at) {
        fio_firmware_say(machine, "wait");
        machine->idle_at = machine->now + seconds;
    }
}

static void report_heating(fio_machine *machine) {
    fio_virtual_printer *printer = machine->printer;
    if (machine->processor != FIO_WAITING || !printer->wait_heater ||
        machine->now < machine->wait_report_at)
        return;
    char bytes[320];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_printer_temperatures(printer, &text);
    fio_text_string(&text, " W:?");
    fio_firmware_say(machine, bytes);
    machine->wait_report_at = machine->now + HEATING_REPORT_SECONDS;
}

void fio_firmware_step(fio_machine *machine) {
    fio_printer_advance(machine->printer, machine->now);
    while (turn(machine))
        ;
    fio_fault_release(machine);
    if (machine->processor == FIO_HALTED || machine->processor == FIO_BOOTING)
        return;
    fio_thermal_check(machine);
    if (machine->processor == FIO_HALTED || machine->now < machine->plan.silent_until)
        return;
    fio_firmware_packet_late(machine);
    say_busy(machine);
    say_wait(machine);
    report_heating(machine);
    fio_firmware_reports(machine);
}

static double next_turn(const fio_machine *machine) {
    const fio_virtual_printer *printer = machine->printer;
    unsigned most, waiting;
    switch (machine->processor) {
    case FIO_BOOTING:
    case FIO_WORKING:
        return machine->until;
    case FIO_IDLE:
        if (machine->queued == 0)
            return INFINITY;
        if (machine->now < machine->plan.busy_until)
            return machine->plan.busy_until;
        waiting = backlog(machine, &most);
        if (waiting <= most)
            return machine->now; /* the host has just made room */
        if (machine->out.byte_seconds == 0)
            return INFINITY;
        return machine->now + (waiting - most + 1) * machine->out.byte_seconds;
    case FIO_BLOCKED:
    case FIO_CHORDS:
        return fio_printer_next(printer);
    case FIO_WAITING:
        return fmin(printer->wait_end, printer->wait_heater ? machine->wait_report_at : INFINITY);
    default:
        return INFINITY;
    }
}

/* Of what the processor does, which a silent one does not. */
static double next_work(const fio_machine *machine) {
    double next = next_turn(machine);
    if (machine->processor == FIO_HALTED || machine->processor == FIO_BOOTING)
        return next;
    if (works_long(machine) && machine->busy_seconds > 0)
        next = fmin(next, machine->busy_at);
    if (machine->transfer.on)
        next = fmin(next, machine->transfer.deadline);
    if (machine->dialect->wait_seconds > 0 && machine->processor == FIO_IDLE)
        next = fmin(next, machine->idle_at);
    return fmin(next, fio_firmware_next_report(machine));
}

double fio_firmware_next(const fio_machine *machine) {
    double next = next_work(machine);
    if (machine->now < machine->plan.silent_until)
        next = machine->plan.silent_until;
    if (machine->processor != FIO_HALTED && machine->processor != FIO_BOOTING)
        next = fmin(next, fio_thermal_next(machine));
    return fmin(next, fmin(fio_fault_next(machine), fio_script_next(machine)));
}
