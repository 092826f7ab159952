#include "control.h"

#include <math.h>
#include <signal.h>

#include "signals.h"
#include "terminal.h"

enum { CANCEL_SECONDS = 5 }; /* within which the second c has to follow */

static const double period = 0.25; /* s between two looks at what is to be told */

/* ---- signals ---- */

static void cancel(fio_control *control, double now, const char *why) {
    if (!control->cancelled && control->job)
        fio_screen_say(&control->narrator->screen,
                       "%s: cancelling and switching the heaters off; once more stops the printer "
                       "at once",
                       why);
    control->cancelled = true;
    fio_streamer_cancel(control->streamer, now);
}

static void emergency(fio_control *control, double now) {
    fio_narrator_warn(control->narrator, "emergency stop");
    fio_streamer_emergency(control->streamer, now);
}

static void interrupt(fio_control *control, double now) {
    switch (++control->interrupts) {
    case 1:
        cancel(control, now, "interrupted");
        break;
    case 2:
        emergency(control, now);
        break;
    default:
        fio_streamer_lost(control->streamer, now, FIO_CANCELLED,
                          "left at once: nobody knows whether the heaters are off");
    }
}

static void stop(fio_control *control) {
    if (control->job) {
        fio_screen_say(&control->narrator->screen,
                       "a job can't be suspended: the nozzle would stand still on the part; p "
                       "pauses it");
        return;
    }
    fio_signals_stop();
}

static void take_signal(fio_control *control, int number, double now) {
    switch (number) {
    case SIGINT:
        interrupt(control, now);
        break;
    case SIGTERM:
        cancel(control, now, "told to end");
        break;
    case SIGHUP:
        cancel(control, now, "the terminal is gone");
        break;
    case SIGQUIT:
        emergency(control, now);
        break;
    case SIGTSTP:
        stop(control);
        break;
    case SIGCONT:
        fio_terminal_continue();
        fio_screen_redraw(&control->narrator->screen);
        break;
    case SIGWINCH:
        fio_screen_redraw(&control->narrator->screen);
        break;
    }
}

/* ---- keys ---- */

static void ask_to_cancel(fio_control *control, double now) {
    if (now - control->cancel_asked <= CANCEL_SECONDS) {
        cancel(control, now, "c");
        return;
    }
    control->cancel_asked = now;
    fio_screen_say(&control->narrator->screen, "c again within %d s cancels the job",
                   CANCEL_SECONDS);
}

/* Also lets a printer go on that waits for its user (M0, M600). */
static void go_on(fio_control *control, double now) {
    if (control->narrator->paused_for_user && fio_streamer_command(control->streamer, now, "M108"))
        fio_screen_say(&control->narrator->screen, "%s", fio_error_message());
    fio_streamer_resume(control->streamer, now);
}

static void take_key(fio_control *control, int key, double now) {
    switch (key) {
    case 'p':
        fio_streamer_pause(control->streamer, now);
        break;
    case 'r':
        go_on(control, now);
        break;
    case 'c':
        ask_to_cancel(control, now);
        break;
    case '!':
        emergency(control, now);
        break;
    case '?':
    case 'h':
        fio_screen_say(&control->narrator->screen,
                       "p pause, r resume, c c cancel, ! emergency stop, ? this");
        break;
    }
}

/* ---- the session's hooks ---- */

/* Commands are taken; before that, lines of a console are left where they are. */
static bool listens(const fio_control *control) {
    return fio_streamer_report(control->streamer)->state == FIO_STREAM_RUNNING;
}

static int descriptors(void *context, struct pollfd *polls, int most) {
    const fio_control *control = context;
    int count = 0;
    (void)most; /* FIO_SESSION_POLLS: six at the most are needed */
    polls[count++] = (struct pollfd){fio_signals_descriptor(), POLLIN, 0};
    if (control->job && fio_terminal_descriptor() >= 0)
        polls[count++] = (struct pollfd){fio_terminal_descriptor(), POLLIN, 0};
    if (control->job && control->job->waits && fio_source_descriptor(control->job->source) >= 0)
        polls[count++] = (struct pollfd){fio_source_descriptor(control->job->source), POLLIN, 0};
    if (control->console && listens(control) && fio_console_waits(control->console, &polls[count]))
        count++;
    return count + fio_narrator_descriptors(control->narrator, polls + count);
}

static void take_input(fio_control *control, double now) {
    if (control->job)
        fio_job_look(control->job);
    for (int number; (number = fio_signals_next()) != 0;)
        take_signal(control, number, now);
    for (int key; control->job && (key = fio_terminal_key()) != 0;)
        take_key(control, key, now);
    fio_narrator_flush(control->narrator);
}

static void woken(void *context, double now, const struct pollfd *polls, int count) {
    fio_control *control = context;
    bool any = false;
    for (int i = 0; i < count; i++)
        any = any || polls[i].revents != 0;
    if (any) /* all of them are read without waiting */
        take_input(control, now);
    if (control->console && listens(control) && !control->cancelled &&
        fio_console_feed(control->console, control->streamer, now) != FIO_OK)
        fio_screen_say(&control->narrator->screen, "%s", fio_error_message());
    if (control->console) {
        control->narrator->temperatures = control->console->temperatures;
        control->narrator->reports = control->console->reports;
    }
    fio_narrator_update(control->narrator, now, fio_streamer_report(control->streamer));
}

fio_session_hooks fio_control_hooks(fio_control *control) {
    control->cancel_asked = -INFINITY;
    return (fio_session_hooks){descriptors, woken, period, control};
}
