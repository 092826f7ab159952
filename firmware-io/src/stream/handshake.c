/* The greeting: who is there, from which number do lines count, where does the job go on. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "stream/state.h"

#define BOOT_SECONDS                                                                               \
    1.5 /* for a "start" to come, of a board that was reset by opening its port                    \
         */
#define STARTED_SECONDS 0.3 /* of more text behind "start" */
#define ANSWER_SECONDS 1.0
#define GREETING_SECONDS 20.0
#define UPLOAD_SECONDS 8.0
enum {
    ATTEMPTS_MOST = 10,
    LAST_ATTEMPTS = 5,
    OBEYED_LEAST = 3,
    NAME_ATTEMPTS = 6,
    STRANGE_ATTEMPTS = 3
};

static void go_to(fio_streamer *streamer, fio_greeting greeting, double seconds) {
    streamer->greeting = greeting;
    streamer->step_until = streamer->now + seconds;
}

void fio_handshake_begin(fio_streamer *streamer) {
    double seconds = streamer->options.greeting_seconds;
    fio_queue_clear(streamer);
    streamer->handshaking = false;
    streamer->recovery.waiting = false;
    streamer->recovery.doubts = 0;
    streamer->attempts = 0;
    streamer->greeting_until = streamer->now + (seconds > 0 ? seconds : GREETING_SECONDS);
    go_to(streamer, FIO_GREETING_BOOT, streamer->options.no_greeting ? 0 : BOOT_SECONDS);
    fio_streamer_enter(streamer, FIO_STREAM_GREETING);
}

/* M110 sets the number of the line before the next, whatever it was. */
void fio_handshake_number(fio_streamer *streamer) {
    char wire[FIO_WIRE_LINE_MOST + 1], command[32];
    fio_text text = fio_text_in(command, sizeof command);
    fio_text_string(&text, "M110 N");
    fio_text_integer(&text, FIO_FIRST_NUMBER);
    size_t length =
        fio_encode_line(wire, FIO_FIRST_NUMBER, command, text.length, FIO_WIRE_LINE_MOST);
    fio_history_restart(streamer, FIO_FIRST_NUMBER);
    streamer->recovery.waiting = false;
    streamer->recovery.doubts = 0;
    streamer->recovery.oks = 0;
    streamer->handshaking = true;
    streamer->step_until = streamer->now + ANSWER_SECONDS;
    streamer->attempts++;
    fio_queue_raw(streamer, "\n", 1); /* what may stand half in its buffer ends here */
    fio_queue_raw(streamer, wire, length);
}

static void ask_name(fio_streamer *streamer) {
    streamer->handshaking = false;
    go_to(streamer, FIO_GREETING_NAME, ANSWER_SECONDS);
    fio_queue_clear(streamer);
    if (streamer->undrained)
        fio_queue_text(streamer, "M400");
    if (!streamer->options.firmware && streamer->firmware.kind != FIO_FIRMWARE_GRBL) {
        streamer->attempts++;
        fio_queue_text(streamer, "M115");
    }
    if (streamer->plain && fio_queue_is_empty(streamer)) {
        streamer->named = true;
        fio_handshake_step(streamer);
        return;
    }
    fio_queue_await(streamer);
}

static void start_numbering(fio_streamer *streamer) {
    bool numbered = streamer->firmware.numbered && !streamer->options.no_numbers;
    streamer->attempts = 0;
    if (!numbered) {
        streamer->plain = true;
        fio_history_restart(streamer, 0);
        ask_name(streamer);
        return;
    }
    streamer->renumbered = true;
    go_to(streamer, FIO_GREETING_NUMBER, ANSWER_SECONDS);
    fio_handshake_number(streamer);
}

/* Read on to where the job goes on; it may be a pipe that has nothing yet. */
static void read_on(fio_streamer *streamer) {
    fio_source_command *command = &streamer->pending;
    while (streamer->greeting == FIO_GREETING_SKIP) {
        fio_source_result result = FIO_SOURCE_COMMAND;
        if (!streamer->has_pending)
            result = streamer->source.next(streamer->source.context, command);
        streamer->has_pending = false;
        if (result == FIO_SOURCE_LATER)
            return;
        if (result == FIO_SOURCE_FAILED) {
            fio_end_now(streamer, FIO_UNREADABLE, "%s", fio_error_message());
            return;
        }
        if (result == FIO_SOURCE_END && streamer->job_sent < streamer->skip) {
            fio_end_now(streamer, FIO_USAGE,
                        "the job has fewer commands than were printed of it: is this the same "
                        "file?");
            return;
        }
        if (result == FIO_SOURCE_END || command->index >= streamer->skip) {
            streamer->has_pending = result == FIO_SOURCE_COMMAND;
            streamer->source_ended = result == FIO_SOURCE_END;
            break;
        }
        if (command->index >= streamer->skip_start && !streamer->started_anew)
            fio_track_follow(&streamer->track, command->text, command->length);
        streamer->job_sent = command->index + 1;
        streamer->report.line = command->line;
        streamer->report.offset = command->offset;
        streamer->report.layer = command->layer;
    }
    streamer->job_sent = streamer->job_accepted = streamer->report.accepted = streamer->skip;
    streamer->skipped = true;
    if (streamer->started_anew) {
        start_numbering(streamer);
    } else {
        streamer->renumbered = false;
        ask_name(streamer);
    }
}

/* The commands before `index` are printed; `from` is where what is known of them begins. */
static void skip_to(fio_streamer *streamer, int64_t index, bool anew) {
    const fio_stream_resume *from = &streamer->from;
    int64_t start = anew ? index : from->accepted;
    streamer->skip = index;
    streamer->skip_start = start;
    streamer->skipped_anew = anew;
    streamer->skipped = false;
    streamer->has_pending = streamer->source_ended = false;
    if (!streamer->source.seek && streamer->job_sent > start) {
        fio_end_now(streamer, FIO_LINK_LOST,
                    "the printer was reset, and the job can't be read again from where to go on");
        return;
    }
    streamer->track = anew ? from->track_made : from->track;
    streamer->track_made = from->track_made;
    streamer->job_made = from->made;
    streamer->undrained = !anew;
    go_to(streamer, FIO_GREETING_SKIP, 0);
    if (streamer->source.seek) {
        fio_status status = streamer->source.seek(streamer->source.context, start);
        if (status != FIO_OK) {
            fio_end_now(streamer, status, "%s", fio_error_message());
            return;
        }
        streamer->job_sent = start;
    }
    read_on(streamer);
}

static void go_on_anew(fio_streamer *streamer) {
    streamer->started_anew = true;
    if (!streamer->has_resume) {
        start_numbering(streamer);
        return;
    }
    skip_to(streamer, streamer->from.made, true);
}

static void go_on_after(fio_streamer *streamer, int64_t last) {
    int64_t index = fio_history_index(&streamer->from, last);
    if (index < 0) {
        go_on_anew(streamer);
        return;
    }
    fio_history_restart(streamer, last);
    streamer->greeting_until += 120; /* what the printer still has to do comes first */
    skip_to(streamer, index, false);
}

static void set_up(fio_streamer *streamer) {
    char command[32];
    go_to(streamer, FIO_GREETING_SET_UP, ANSWER_SECONDS);
    streamer->renumbered = false;
    fio_streamer_say(streamer, FIO_STREAM_FIRMWARE, NULL, -1);
    if (streamer->firmware.auto_temperatures && !streamer->options.upload) {
        fio_text text = fio_text_in(command, sizeof command);
        double seconds = streamer->options.report_seconds;
        fio_text_string(&text, "M155 S");
        fio_text_integer(&text, seconds >= 1 ? (int64_t)seconds : seconds > 0 ? 1 : 2);
        fio_queue_text(streamer, command);
    }
    if (fio_queue_is_empty(streamer))
        fio_handshake_step(streamer);
    else
        fio_queue_await(streamer);
}

static bool open_file(fio_streamer *streamer) {
    char command[FIO_WIRE_LINE_MOST];
    fio_text text = fio_text_in(command, sizeof command);
    fio_text_string(&text, "M28 ");
    fio_text_string(&text, streamer->options.upload);
    if (!fio_history_has_room(streamer) || !fio_queue_command(streamer, command, text.length)) {
        fio_end_now(streamer, FIO_USAGE, "the name \"%s\" is too long", streamer->options.upload);
        return false;
    }
    streamer->opened_file = true; /* from now on whatever is sent is written */
    streamer->step_until = streamer->now + UPLOAD_SECONDS;
    return true;
}

static void restore(fio_streamer *streamer) {
    char text[FIO_TRACK_TEXT];
    const fio_track *track = &streamer->track;
    bool stood = track->homed || track->known[0] || track->known[1] || track->known[2];
    if (!streamer->has_resume || !stood) {
        fio_streamer_enter(streamer, FIO_STREAM_RUNNING);
        return;
    }
    go_to(streamer, FIO_GREETING_RESTORE, INFINITY);
    fio_track_restore(track, streamer->started_anew, streamer->options.lift,
                      streamer->started_anew ? streamer->options.retract : 0, text);
    fio_queue_restore(streamer, text);
    fio_queue_await(streamer);
}

/* A name that nobody knows may be a known one with a wrong bit. */
static bool name_is_doubtful(const fio_streamer *streamer) {
    bool strange = streamer->firmware.kind == FIO_FIRMWARE_UNKNOWN;
    int attempts = !streamer->named ? NAME_ATTEMPTS : strange ? STRANGE_ATTEMPTS : 0;
    return !streamer->options.firmware && streamer->attempts < attempts;
}

void fio_handshake_step(fio_streamer *streamer) {
    switch (streamer->greeting) {
    case FIO_GREETING_NAME:
        if (name_is_doubtful(streamer)) {
            ask_name(streamer);
            return;
        }
        if (!streamer->named && !streamer->options.firmware)
            streamer->echoes = true; /* it does not say who it is: to be tried */
        if (!streamer->plain && (!streamer->firmware.numbered || streamer->options.no_numbers)) {
            streamer->plain = true;
            fio_history_restart(streamer, 0);
        }
        set_up(streamer);
        return;
    case FIO_GREETING_SET_UP:
        if (!streamer->options.upload)
            restore(streamer);
        else
            open_file(streamer);
        return;
    case FIO_GREETING_RESTORE:
        fio_streamer_enter(streamer, FIO_STREAM_RUNNING);
        return;
    default:
        return;
    }
}

static void repeat_last(fio_streamer *streamer) {
    if (++streamer->attempts > LAST_ATTEMPTS && streamer->obeyed >= OBEYED_LEAST) {
        go_on_anew(streamer); /* it does what no firmware that counts lines would do */
        return;
    }
    go_to(streamer, FIO_GREETING_LAST, ANSWER_SECONDS);
    if (streamer->raw_length > 0)
        return;                         /* the link does not even take what was to be said before */
    fio_queue_raw(streamer, "\n\n", 2); /* half a line stands there: it must not get a tail */
    fio_recovery_provoke(streamer);
}

static void leave_boot(fio_streamer *streamer) {
    if (streamer->has_resume && streamer->skipped && streamer->skipped_anew)
        start_numbering(streamer);
    else if (streamer->has_resume && streamer->from.number >= 0 && !streamer->started_anew)
        repeat_last(streamer);
    else
        go_on_anew(streamer);
}

static void number_again(fio_streamer *streamer) {
    if (streamer->raw_length > 0)
        streamer->step_until = streamer->now + ANSWER_SECONDS;
    else if (streamer->attempts < ATTEMPTS_MOST || streamer->state == FIO_STREAM_GREETING)
        fio_handshake_number(streamer);
    else
        streamer->step_until = INFINITY; /* the end has its own time */
}

static void give_up(fio_streamer *streamer) {
    const char *hint =
        streamer->halted    ? "it is halted: switch it off and on, or reset it"
        : streamer->rubbish ? "what comes is rubbish: the rate is wrong; --baud auto finds it"
        : streamer->pulse.heard > streamer->started
            ? "it says something, but does not answer: is another program using it?"
            : "nothing came back: is it switched on, and is the rate right (--baud auto finds it)?";
    fio_end_now(streamer, FIO_NO_PRINTER, "no printer answers after %.0f s: %s",
                streamer->now - streamer->started, hint);
}

void fio_handshake_tick(fio_streamer *streamer) {
    bool due = streamer->now >= streamer->step_until;
    if (streamer->handshaking && due)
        number_again(streamer);
    if (streamer->state != FIO_STREAM_GREETING)
        return;
    if (streamer->greeting < FIO_GREETING_SKIP && streamer->now >= streamer->greeting_until) {
        give_up(streamer);
        return;
    }
    switch (streamer->greeting) {
    case FIO_GREETING_BOOT:
        if (due)
            leave_boot(streamer);
        break;
    case FIO_GREETING_LAST:
        if (due)
            repeat_last(streamer);
        break;
    case FIO_GREETING_BANNER:
        if (due)
            start_numbering(streamer);
        break;
    case FIO_GREETING_SKIP:
        read_on(streamer);
        break;
    case FIO_GREETING_SET_UP:
        if (due && streamer->opened_file)
            fio_end(streamer, FIO_FAULTY, false, "the printer did not open the file \"%s\"",
                    streamer->options.upload);
        break;
    default:
        break;
    }
}

double fio_handshake_deadline(const fio_streamer *streamer) {
    double deadline = streamer->handshaking ? streamer->step_until : INFINITY;
    if (streamer->state != FIO_STREAM_GREETING)
        return deadline;
    if (streamer->greeting == FIO_GREETING_SKIP || streamer->greeting == FIO_GREETING_RESTORE)
        return INFINITY;
    if (streamer->greeting == FIO_GREETING_NAME)
        return streamer->greeting_until;
    if (streamer->greeting == FIO_GREETING_SET_UP)
        return streamer->opened_file ? streamer->step_until : streamer->greeting_until;
    return fmin(fmin(deadline, streamer->step_until), streamer->greeting_until);
}

/* RepRapFirmware's M118 is another one, Klipper's is an option, the others have none. */
static void set_firmware(fio_streamer *streamer, const fio_firmware *firmware) {
    streamer->firmware = *firmware;
    streamer->echoes =
        firmware->kind == FIO_FIRMWARE_MARLIN || firmware->kind == FIO_FIRMWARE_PRUSA;
}

static void started(fio_streamer *streamer, const fio_answer *answer) {
    const fio_firmware *firmware = fio_firmware_identify(answer);
    if (!streamer->options.firmware && firmware->kind > FIO_FIRMWARE_UNKNOWN &&
        firmware->kind < FIO_FIRMWARE_KINDS)
        set_firmware(streamer, firmware);
    streamer->started_anew = true;
    streamer->opened_file = streamer->halted = false;
    fio_queue_clear(streamer);
    streamer->handshaking = false;
    go_to(streamer, FIO_GREETING_BOOT, STARTED_SECONDS);
}

/* Klipper tells its name behind an ok. */
static bool tells_name(const fio_answer *answer) {
    return answer->kind == FIO_ANSWER_FIRMWARE ||
           (answer->kind == FIO_ANSWER_OK &&
            fio_firmware_identify(answer)->kind != FIO_FIRMWARE_UNKNOWN);
}

void fio_handshake_hear(fio_streamer *streamer, const fio_answer *answer) {
    if (streamer->state != FIO_STREAM_GREETING)
        return;
    if (answer->kind == FIO_ANSWER_START && streamer->greeting != FIO_GREETING_RESTORE)
        started(streamer, answer);
    if (answer->kind == FIO_ANSWER_BUSY)
        streamer->greeting_until = fmax(streamer->greeting_until, streamer->now + 10);
    if (tells_name(answer) && !streamer->options.firmware) {
        set_firmware(streamer, fio_firmware_identify(answer));
        fio_firmware_learn(&streamer->firmware, answer);
        streamer->named = true;
        if (streamer->greeting == FIO_GREETING_BANNER && !streamer->firmware.numbered)
            start_numbering(streamer);
    }
    bool refused = answer->kind == FIO_ANSWER_ERROR && answer->text[0] == 'e'; /* "error:20" */
    if (refused && !streamer->plain &&
        (streamer->greeting == FIO_GREETING_NUMBER || streamer->greeting == FIO_GREETING_NAME)) {
        streamer->handshaking = false; /* it knows neither M110 nor M115: grbl tells by $I */
        fio_queue_clear(streamer);
        go_to(streamer, FIO_GREETING_BANNER, ANSWER_SECONDS);
        fio_queue_raw(streamer, "$I\n", 3);
    }
    if (streamer->greeting == FIO_GREETING_SET_UP && streamer->opened_file &&
        strstr(answer->text, "Writing to file"))
        fio_streamer_enter(streamer, FIO_STREAM_RUNNING);
    if (streamer->greeting == FIO_GREETING_SET_UP && streamer->opened_file &&
        strstr(answer->text, "open failed")) {
        streamer->opened_file = false;
        fio_end(streamer, FIO_FAULTY, false, "the printer can't write the file \"%s\": %s",
                streamer->options.upload, answer->text);
    }
}

bool fio_handshake_halted(fio_streamer *streamer) {
    streamer->halted = true;
    return streamer->state == FIO_STREAM_GREETING && streamer->greeting < FIO_GREETING_NAME;
}

bool fio_handshake_ok(fio_streamer *streamer, const fio_answer *answer) {
    if (streamer->state == FIO_STREAM_GREETING && streamer->greeting < FIO_GREETING_NUMBER) {
        streamer->obeyed += streamer->greeting == FIO_GREETING_LAST && answer->has_temperatures;
        return true;
    }
    if (!streamer->handshaking)
        return false;
    if (streamer->raw_length > 0 || streamer->out_done < streamer->out_length)
        return true; /* of something before it */
    streamer->handshaking = false;
    fio_recovery_progress(streamer);
    if (streamer->state == FIO_STREAM_GREETING) {
        streamer->attempts = 0;
        ask_name(streamer);
    } else if (streamer->ending) {
        fio_end_again(streamer);
    }
    return true;
}

bool fio_handshake_resend(fio_streamer *streamer, int64_t number) {
    bool greeting = streamer->state == FIO_STREAM_GREETING;
    if (greeting && streamer->greeting == FIO_GREETING_LAST) {
        streamer->recovery.oks = 1;
        if (streamer->told_last == number - 1) {
            go_on_after(streamer, number - 1);
            return true;
        }
        streamer->told_last = number - 1;
        repeat_last(streamer);
        return true;
    }
    if (streamer->handshaking) {
        streamer->recovery.oks = 1; /* M110 itself was damaged: its turn comes again soon */
        streamer->step_until = fmin(streamer->step_until, streamer->now + 0.1);
        return true;
    }
    if (greeting && streamer->greeting < FIO_GREETING_NUMBER)
        return true; /* said to somebody before us */
    bool fresh = streamer->accepted == FIO_FIRST_NUMBER && (greeting || streamer->ending);
    if (fresh && (number <= streamer->accepted || number > streamer->next) &&
        streamer->renumbered) {
        streamer->recovery.oks = 1;
        number_again(streamer);
        return true;
    }
    return false;
}
