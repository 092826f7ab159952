#include "narrator.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "utf8.h"

enum {
    PIPE_SECONDS = 600, /* between lines about a job whose length is not known */
    COMPLAINTS_SAID = 5 /* in a while: a bad cable makes hundreds */
};
#define COMPLAINTS_SECONDS 900.0

void fio_narrator_open(fio_narrator *narrator, const fio_arguments *arguments) {
    fio_screen_open(&narrator->screen, arguments->quiet);
    fio_output_share(&narrator->out, STDOUT_FILENO);
    narrator->use_json = arguments->json;
    narrator->tenth = 0;
    narrator->told = -INFINITY;
}

/* ---- JSON ---- */

void fio_narrator_object(fio_narrator *narrator) {
    fio_json_end(&narrator->json);
    fio_output_line(&narrator->out, narrator->json.bytes, narrator->json.text.length);
}

/* False if nobody wants JSON; else the object is begun. */
static bool begin(fio_narrator *narrator, const char *event) {
    if (!narrator->use_json)
        return false;
    fio_json_begin(&narrator->json, event);
    fio_json_number(&narrator->json, "time", narrator->now - narrator->start, 3);
    return true;
}

static void simple(fio_narrator *narrator, const char *event, const char *key, const char *value,
                   size_t size) {
    if (!begin(narrator, event))
        return;
    fio_json_bytes(&narrator->json, key, value, size);
    fio_narrator_object(narrator);
}

static void temperatures(fio_json *json, const fio_stream_report *report) {
    if (report->has_temperatures) {
        fio_json_number(json, "nozzle", report->nozzle, 2);
        fio_json_number(json, "nozzle_target", report->nozzle_target, 2);
    }
    if (report->has_bed) {
        fio_json_number(json, "bed", report->bed, 2);
        fio_json_number(json, "bed_target", report->bed_target, 2);
    }
}

static void counts(fio_json *json, const fio_stream_report *report) {
    fio_json_integer(json, "sent", report->sent);
    fio_json_integer(json, "accepted", report->accepted);
    fio_json_integer(json, "line", report->line);
    fio_json_integer(json, "layer", report->layer);
    fio_json_integer(json, "resends", report->resends);
}

static void progress_object(fio_narrator *narrator, const fio_stream_report *report) {
    const fio_progress *progress = &narrator->progress;
    fio_json *json = &narrator->json;
    if (!begin(narrator, "progress"))
        return;
    fio_json_string(json, "state", fio_progress_state_name(report->state));
    if (progress->share >= 0)
        fio_json_number(json, "percent", progress->share * 100, 2);
    if (progress->seconds_left >= 0)
        fio_json_number(json, "seconds_left", progress->seconds_left, 0);
    counts(json, report);
    temperatures(json, report);
    fio_narrator_object(narrator);
}

void fio_narrator_start(fio_narrator *narrator, double now, const char *port,
                        const fio_source_summary *whole, const char *file) {
    static const fio_source_summary unknown = {-1, -1, -1};
    narrator->start = narrator->now = now;
    fio_dialogue_start(&narrator->dialogue, now);
    fio_progress_begin(&narrator->progress, whole ? whole : &unknown);
    if (!begin(narrator, "start"))
        return;
    fio_json_string(&narrator->json, "version", FIO_VERSION);
    fio_json_string(&narrator->json, "port", port);
    if (file)
        fio_json_string(&narrator->json, "file", file);
    if (whole && whole->bytes >= 0)
        fio_json_integer(&narrator->json, "bytes", whole->bytes);
    if (whole && whole->layers >= 0)
        fio_json_integer(&narrator->json, "layers", whole->layers);
    if (whole && whole->seconds >= 0)
        fio_json_number(&narrator->json, "seconds", whole->seconds, 0);
    fio_narrator_object(narrator);
}

/* ---- events of the streamer ---- */

static void say_of_unsaid(fio_narrator *narrator) {
    if (narrator->unsaid > 0)
        fio_screen_say(&narrator->screen,
                       "%" PRId64 " more messages of this sort; --log keeps them all",
                       narrator->unsaid);
    narrator->said = 0;
    narrator->unsaid = 0;
}

static bool may_complain(fio_narrator *narrator) {
    if (narrator->said == 0)
        narrator->said_since = narrator->now;
    if (narrator->said < COMPLAINTS_SAID) {
        narrator->said++;
        return true;
    }
    narrator->unsaid++;
    return false;
}

static void warn(fio_narrator *narrator, const char *text, size_t size, bool say) {
    char bytes[700];
    fio_text visible = fio_text_in(bytes, sizeof bytes);
    fio_utf8_visible(&visible, text, size);
    if (!narrator->answers && say)
        fio_screen_say(&narrator->screen, "%s", bytes);
    fio_dialogue_add(&narrator->dialogue, narrator->now, '#', text, size);
    simple(narrator, "warning", "text", text, size);
}

void fio_narrator_warn(fio_narrator *narrator, const char *text) {
    warn(narrator, text, strlen(text), true);
}

static void say_of_printer(fio_narrator *narrator, const char *what, const char *text,
                           size_t size) {
    char bytes[700];
    fio_text visible = fio_text_in(bytes, sizeof bytes);
    fio_utf8_visible(&visible, text, size);
    fio_screen_say(&narrator->screen, "%s: %s", what, bytes);
}

static void firmware(fio_narrator *narrator, const fio_firmware *known) {
    fio_json *json = &narrator->json;
    fio_screen_say(&narrator->screen, "the printer's firmware is %s%s", known->name,
                   known->numbered ? "" : ", which does not check numbers of lines");
    if (!begin(narrator, "firmware"))
        return;
    fio_json_string(json, "name", known->name);
    fio_json_boolean(json, "numbered", known->numbered);
    fio_json_integer(json, "receive_bytes", known->receive_bytes);
    fio_json_integer(json, "command_slots", known->command_slots);
    fio_json_boolean(json, "emergency_parser", known->emergency_parser);
    fio_narrator_object(narrator);
}

static bool is_complaint(const fio_answer *answer) {
    /* An error that names a line is one of the link, which the streamer mends. */
    return answer->kind == FIO_ANSWER_HALTED || answer->kind == FIO_ANSWER_PREVENTED ||
           (answer->kind == FIO_ANSWER_ERROR && answer->line < 0);
}

/* Not told as JSON: what comes all the time and is in the progress. */
static bool is_routine(const fio_answer *answer) {
    return answer->kind == FIO_ANSWER_OK || answer->kind == FIO_ANSWER_TEMPERATURES ||
           answer->kind == FIO_ANSWER_RESEND || answer->kind == FIO_ANSWER_BUSY ||
           answer->kind == FIO_ANSWER_WAIT;
}

/* isoprint's own M118 with seven hexadecimal digits: "N12 M118 0123abc*99", "N12 M0118 …". */
static bool read_token(char token[8], const char *text, size_t length) {
    const char *end = text + length;
    const char *word = text + (length > 0 && *text == 'N' ? strcspn(text, " ") : 0);
    word += word < end && *word == ' ';
    size_t name = !strncmp(word, "M118 ", 5) ? 5 : !strncmp(word, "M0118 ", 6) ? 6 : 0;
    if (name == 0 || strspn(word + name, "0123456789abcdef") != 7)
        return false;
    memcpy(token, word + name, 7);
    token[7] = 0;
    return true;
}

static void sent(fio_narrator *narrator, const fio_stream_event *event) {
    char text[FIO_ANSWER_MOST + 1];
    fio_text copy = fio_text_in(text, sizeof text);
    fio_text_bytes(&copy, event->text, event->length);
    fio_dialogue_add(&narrator->dialogue, event->time, '>', event->text, event->length);
    if (!narrator->answers || narrator->under_way == 64)
        return;
    bool own = read_token(narrator->token, text, copy.length);
    if (own || event->state == FIO_STREAM_GREETING)
        narrator->own |= UINT64_C(1) << narrator->under_way;
    narrator->under_way++;
}

/* Something that somebody at a console did not ask for. */
static bool is_own(fio_narrator *narrator, const fio_stream_event *event) {
    const fio_answer *said = event->answer;
    bool greeting = event->state == FIO_STREAM_GREETING;
    if (said->kind == FIO_ANSWER_START)
        narrator->own = narrator->under_way = 0;
    if (said->kind == FIO_ANSWER_TEMPERATURES)
        return greeting || !narrator->reports;
    if (said->kind != FIO_ANSWER_OK)
        return greeting || (*narrator->token && strstr(said->text, narrator->token));
    bool own = narrator->under_way > 0 && (narrator->own & 1);
    narrator->under_way -= narrator->under_way > 0;
    narrator->own >>= 1;
    return greeting || own || (said->has_temperatures && !narrator->temperatures);
}

static void answer(fio_narrator *narrator, const fio_stream_event *event) {
    const fio_answer *said = event->answer;
    fio_dialogue_add(&narrator->dialogue, narrator->now, '<', said->text, said->length);
    bool waits = said->kind == FIO_ANSWER_BUSY && said->busy != FIO_BUSY_PROCESSING;
    if (waits && !narrator->paused_for_user)
        fio_screen_say(&narrator->screen, "the printer waits for somebody; r goes on");
    if (said->kind == FIO_ANSWER_BUSY || said->kind == FIO_ANSWER_OK)
        narrator->paused_for_user = waits;
    if (is_complaint(said)) {
        narrator->complaints++;
        bool warned = said->kind == FIO_ANSWER_ERROR; /* that comes as a warning, too */
        if (!narrator->answers && !warned &&
            (said->kind == FIO_ANSWER_HALTED || may_complain(narrator)))
            say_of_printer(narrator, "the printer says", said->text, said->length);
    }
    bool hidden = narrator->answers ? is_own(narrator, event) : is_routine(said);
    if (hidden)
        return;
    if (narrator->use_json) {
        simple(narrator, "answer", "text", said->text, said->length);
    } else if (narrator->answers) {
        char bytes[FIO_ANSWER_MOST * 2];
        fio_text visible = fio_text_in(bytes, sizeof bytes);
        fio_utf8_visible(&visible, said->text, said->length);
        fio_text_string(&visible, "\n");
        fio_output_line(&narrator->out, bytes, visible.length);
    }
}

static void state(fio_narrator *narrator, fio_stream_state now) {
    const char *name = fio_progress_state_name(now);
    if (narrator->answers && now == FIO_STREAM_RUNNING)
        name = "ready";
    simple(narrator, "state", "state", name, strlen(name));
    if (narrator->answers)
        return;
    if (now == FIO_STREAM_PAUSED)
        fio_screen_say(&narrator->screen, "paused; r goes on, c cancels");
    else if (now == FIO_STREAM_RESUMING)
        fio_screen_say(&narrator->screen, "going back to where the job was");
}

void fio_narrator_event(fio_narrator *narrator, const fio_stream_event *event) {
    narrator->now = event->time;
    switch (event->kind) {
    case FIO_STREAM_STATE:
        state(narrator, event->state);
        break;
    case FIO_STREAM_FIRMWARE:
        if (!narrator->answers || narrator->use_json)
            firmware(narrator, event->firmware);
        break;
    case FIO_STREAM_ANSWER:
        answer(narrator, event);
        break;
    case FIO_STREAM_SENT:
        sent(narrator, event);
        break;
    case FIO_STREAM_RESEND: /* the lines under way are lost, and an ok follows */
        narrator->own = narrator->under_way = 1;
        if (begin(narrator, "resend")) {
            fio_json_integer(&narrator->json, "number", event->number);
            fio_narrator_object(narrator);
        }
        break;
    case FIO_STREAM_WARNING:
        warn(narrator, event->text, event->length, may_complain(narrator));
        break;
    case FIO_STREAM_PROMPT:
        if (event->length > 0)
            say_of_printer(narrator, "the printer asks", event->text, event->length);
        simple(narrator, "prompt", "text", event->text, event->length);
        break;
    case FIO_STREAM_MARK:
    case FIO_STREAM_EVENTS:
        break;
    }
}

/* ---- progress ---- */

static void line_of_terminal(fio_narrator *narrator, const fio_stream_report *report) {
    char bytes[256];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    if (report->state != FIO_STREAM_RUNNING || report->accepted == 0) {
        fio_text_string(&text, fio_progress_state_name(report->state));
        fio_text_string(&text, ": ");
    }
    fio_progress_describe(&text, &narrator->progress, report);
    fio_screen_line(&narrator->screen, bytes);
}

static void line_of_pipe(fio_narrator *narrator, const fio_stream_report *report) {
    char bytes[256];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    int tenth = narrator->progress.share >= 0 ? (int)(narrator->progress.share * 10 + 1e-9) : 0;
    bool late = narrator->progress.share < 0 && narrator->now - narrator->told >= PIPE_SECONDS;
    if ((tenth <= narrator->tenth && !late) || report->accepted == 0)
        return;
    fio_progress_describe(&text, &narrator->progress, report);
    fio_screen_say(&narrator->screen, "%s", bytes);
    narrator->tenth = tenth;
    if (!narrator->use_json)
        narrator->told = narrator->now;
}

void fio_narrator_update(fio_narrator *narrator, double now, const fio_stream_report *report) {
    narrator->now = now;
    if (narrator->said > 0 && now - narrator->said_since >= COMPLAINTS_SECONDS)
        say_of_unsaid(narrator);
    if (narrator->has_job && report->state != FIO_STREAM_DONE) {
        fio_progress_update(&narrator->progress, report, now);
        if (narrator->screen.is_terminal)
            line_of_terminal(narrator, report);
        else
            line_of_pipe(narrator, report);
        if (narrator->use_json && now - narrator->told >= 1) {
            progress_object(narrator, report);
            narrator->told = now;
        }
    }
    fio_dialogue_flush(&narrator->dialogue, now);
}

/* ---- the end ---- */

static void end_object(fio_narrator *narrator, fio_status status, const fio_stream_report *report,
                       const char *resume) {
    fio_json *json = &narrator->json;
    if (!begin(narrator, "end"))
        return;
    fio_json_integer(json, "status", status);
    fio_json_string(json, "message", status == FIO_OK ? "" : fio_error_message());
    if (report) {
        counts(json, report);
        temperatures(json, report);
        fio_json_boolean(json, "heaters_off", report->heaters_off);
        fio_json_integer(json, "lines_sent", report->lines_sent);
        fio_json_integer(json, "bytes_sent", report->bytes_sent);
    }
    fio_json_string(json, "resume", resume);
    fio_narrator_object(narrator);
}

void fio_narrator_end(fio_narrator *narrator, fio_status status, const fio_stream_report *report,
                      const char *resume) {
    narrator->ended = true;
    say_of_unsaid(narrator);
    end_object(narrator, status, report, resume);
    if (status != FIO_OK) {
        const char *message = fio_error_message();
        fio_dialogue_add(&narrator->dialogue, narrator->now, '#', message, strlen(message));
        return;
    }
    if (!narrator->has_job || !report)
        return;
    bool hot = report->resume.track.bed > 0;
    for (int i = 0; i < FIO_TRACK_TOOLS; i++)
        hot = hot || report->resume.track.nozzle[i] > 0;
    if (hot && !report->heaters_off && !narrator->upload)
        fio_screen_say(&narrator->screen,
                       "the job has left heaters on; --heaters-off switches them "
                       "off at its end");
    char bytes[64];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_progress_duration(&text, narrator->now - narrator->start);
    if (narrator->screen.is_terminal) {
        fio_progress_update(&narrator->progress, report, narrator->now);
        line_of_terminal(narrator, report);
    }
    fio_screen_say(&narrator->screen, "%s in %s: %" PRId64 " commands, %" PRId64 " sent again",
                   narrator->started  ? "written to the card and begun"
                   : narrator->upload ? "written to the card"
                                      : "printed",
                   bytes, report->accepted, report->repeats);
}

int fio_narrator_descriptors(const fio_narrator *narrator, struct pollfd *polls) {
    int count = 0;
    count += fio_output_waits(&narrator->out, &polls[count]);
    count += fio_output_waits(&narrator->screen.output, &polls[count]);
    if (narrator->dialogue.path)
        count += fio_output_waits(&narrator->dialogue.output, &polls[count]);
    return count;
}

void fio_narrator_flush(fio_narrator *narrator) {
    fio_output_flush(&narrator->out);
    fio_output_flush(&narrator->screen.output);
    if (narrator->dialogue.path && !narrator->dialogue.output.is_file)
        fio_output_flush(&narrator->dialogue.output);
}

fio_status fio_narrator_close(fio_narrator *narrator) {
    int64_t lines = narrator->out.dropped;
    fio_status status = fio_dialogue_close(&narrator->dialogue);
    bool whole = fio_output_close(&narrator->out, 2);
    if (status == FIO_OK && !whole)
        status = narrator->out.error
                     ? fio_fail(FIO_NOT_WRITTEN, "standard output can't be written: %s",
                                strerror(narrator->out.error))
                     : fio_fail(FIO_NOT_WRITTEN,
                                "standard output was not read in time: %" PRId64
                                " lines or more are missing",
                                lines);
    return status;
}
