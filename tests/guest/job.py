"""The job that every scenario prints: each line of it differs from all others, and from what a host
adds of its own, so that in a list of executed lines those of the job tell their places."""

MOVES = 160

# In the middle of a line somewhere in its second half, for a second of real time at 50 times the speed.
PULL = "at byte 4007 unplug for 50\n"


def lines(rest=False):
    """`rest`: with a dwell in its middle, four seconds of real time at 50 times the speed."""
    yield from ("M109 S205", "G28", "G90", "M83", "G1 X50.125 Y50.125 Z0.3 F9000")
    for i in range(MOVES):
        if rest and i == MOVES // 2:
            yield "G4 S200"
        yield f"G1 X{60 + i % 20 * 0.25:.3f} Y{60 + i * 0.375:.3f} E{0.004 + i * 0.00001:.5f}"
    yield from ("G1 Z5.625 F1200", "M104 S0 T0", "M84 E")


def text(rest=False):
    """As a slicer would write it: with comments, empty lines and blanks that no printer gets."""
    made = ["; a job for the guest", ""]
    for i, line in enumerate(lines(rest)):
        made.append(line + ("  ; a comment" if i % 7 == 3 else ""))
        if i % 50 == 20:
            made.append(";LAYER_CHANGE")
    return "\n".join(made) + "\n"
