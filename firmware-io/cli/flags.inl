/* The flags of isoprint.
 *
 *     FIO_FLAG(name, letter, argument, range, help)
 *     FIO_FLAG_GROUP(title)
 *
 * '_' stands for '-'. letter 0: it has none. argument "": it is a switch. range: unit, least and
 * most, and what holds without it; "" where there is nothing to say. */
FIO_FLAG_GROUP("The printer")
FIO_FLAG(
    port, 'p', "PORT", "auto",
    "Where the printer is: auto, usb:VID:PID[:SERIAL], tty:PATH, socket:PATH, tcp:HOST:PORT or "
    "virtual[:SCRIPT]. auto takes the only one there is. The environment variable "
    "ISOPRINT_PORT says the same.")
FIO_FLAG(baud, 'b', "RATE", "bits/s, 1200 to 4000000, or auto; 115200",
         "Speed of the serial line. Boards with USB of their own ignore it. auto tries the usual "
         "ones until a firmware answers.")
FIO_FLAG(wait, 'w', "SECONDS", "s, 0 to 86400; 0", "Wait so long for the port to appear.")
FIO_FLAG(no_reset, 0, "", "",
         "Leave the lines DTR and RTS alone, so that a board does not restart when it is opened.")
FIO_FLAG(firmware, 0, "NAME", "asked by M115",
         "Take the printer's firmware to be this, whatever it says of itself: marlin, prusa, "
         "klipper, reprapfirmware, smoothie, repetier or grbl.")
FIO_FLAG(window, 0, "LINES[:BYTES]", "1 to 64 lines, 16 to 65536 bytes; as the firmware tells",
         "Most lines, and bytes, sent before they are answered.")
FIO_FLAG(
    virtual, 0, "NAME=VALUE,...", "speed=1",
    "How the printer behind the port virtual is: speed (times real time; 0: as fast as can be), "
    "firmware, flip_in, lose_ok, ... and what else docs/isoprint.md lists.")
FIO_FLAG(list, 0, "", "", "List the ports that a printer may be behind, then end.")
FIO_FLAG(probe, 0, "", "",
         "With --list: open each port and ask for its firmware. That restarts some boards.")
FIO_FLAG_GROUP("The job")
FIO_FLAG(dry_run, 'n', "", "",
         "Check the job and say how large and how long it is, without a printer.")
FIO_FLAG(bed, 0, "XxYxZ", "mm, 1 to 10000 each",
         "With --dry-run: size of the printer's volume, which the job must not leave.")
FIO_FLAG(journal, 0, "FILE|none", "FILE.journal beside the job",
         "Where it is written down how far the job came. Removed when the job is done.")
FIO_FLAG(resume_from, 0, "JOURNAL|LINE", "",
         "Go on with a job that broke off: where its journal says, or at this line of the file.")
FIO_FLAG(on_pause, 0, "FILE", "at most 40 commands", "G-code to run after the job was paused.")
FIO_FLAG(on_cancel, 0, "FILE", "at most 40 commands", "G-code to run after the job was cancelled.")
FIO_FLAG(heaters_off, 0, "", "", "Switch the heaters off at the end, even if the job does not.")
FIO_FLAG(yes, 'y', "", "", "Answer yes to what would be asked: begin anew over a journal.")
FIO_FLAG_GROUP("Other work")
FIO_FLAG(upload, 0, "NAME", "1 to 64 characters",
         "Write the job to this file of the printer's SD card instead of running it.")
FIO_FLAG(start, 0, "", "", "With --upload: print the file from the card once it is there.")
FIO_FLAG(send, 's', "COMMAND", "", "Send this command and print the answers. May be given again.")
FIO_FLAG(console, 0, "", "", "Send the lines of standard input as they come and print the answers.")
FIO_FLAG_GROUP("What is told")
FIO_FLAG(log, 'l', "FILE", "",
         "Write the whole dialogue with the printer, each line with its time.")
FIO_FLAG(json, 'j', "", "", "Tell everything on standard output as JSON, one object a line.")
FIO_FLAG(quiet, 'q', "", "", "Say nothing but errors.")
FIO_FLAG(man, 0, "", "", "Print the manual page; isoprint --man | man -l - shows it.")
FIO_FLAG(version, 0, "", "", "Print the version.")
FIO_FLAG(help, 'h', "", "", "Print this help.")
