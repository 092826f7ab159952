/* isoprint: send G-code to a printer and see it through. */
#include <fcntl.h>
#include <stdio.h>

#include "check.h"
#include "list.h"
#include "print.h"
#include "signals.h"

static fio_status work(const fio_arguments *arguments, fio_control *control) {
    switch (arguments->work) {
    case FIO_WORK_PRINT:
    case FIO_WORK_UPLOAD:
        return fio_print_run(arguments, control);
    case FIO_WORK_CHECK:
        return fio_check_run(arguments, control->narrator);
    case FIO_WORK_SEND:
    case FIO_WORK_CONSOLE:
        return fio_print_commands(arguments, control);
    case FIO_WORK_LIST:
        return fio_list_print(arguments, control);
    case FIO_WORK_HELP:
    case FIO_WORK_VERSION:
    case FIO_WORK_MAN:
        break;
    }
    fio_page_print(arguments->work);
    return FIO_OK;
}

/* With what was told along the way: not being able to tell it is a failure of its own. */
static fio_status work_and_tell(const fio_arguments *arguments) {
    static fio_narrator narrator;
    static fio_control control;
    control.narrator = &narrator;
    fio_narrator_open(&narrator, arguments);
    fio_status status = fio_signals_catch();
    if (status == FIO_OK)
        status = work(arguments, &control);
    if (!narrator.ended)
        fio_narrator_end(&narrator, status, NULL, "");
    if (status != FIO_OK && !control.told)
        fio_screen_fail(&narrator.screen, "%s", fio_error_message());
    fio_status told = fio_narrator_close(&narrator);
    if (told != FIO_OK)
        fio_screen_fail(&narrator.screen, "%s", fio_error_message());
    fio_screen_close(&narrator.screen);
    return status != FIO_OK ? status : told;
}

/* A port must not take the number of a standard descriptor that is closed: messages would go to the
 * printer. What stands there instead fails as the closed one would. */
static void fill_standard_descriptors(void) {
    static const char *const paths[3] = {"/dev/null", "/dev/full", "/dev/null"};
    for (int i = 0; i < 3; i++)
        if (fcntl(i, F_GETFD) < 0)
            (void)open(paths[i], O_WRONLY);
}

int main(int argc, char **argv) {
    fio_arguments arguments;
    fill_standard_descriptors();
    fio_status status = fio_arguments_read(&arguments, argc, argv);
    if (status != FIO_OK)
        fprintf(stderr, "isoprint: %s\n", fio_error_message());
    else if (arguments.work >= FIO_WORK_HELP)
        status = work(&arguments, NULL);
    else
        status = work_and_tell(&arguments);
    if (fflush(stdout) != 0 && status == FIO_OK) {
        fprintf(stderr, "isoprint: standard output can't be written\n");
        status = FIO_NOT_WRITTEN;
    }
    return (int)status;
}
