#include "virtual/reader.h"

bool fio_reader_feed(fio_reader *reader, char c) {
    if (reader->done)
        *reader = (fio_reader){0};
    if (c == '\n' || c == '\r') {
        reader->text[reader->length] = 0;
        reader->done = true;
        return reader->length > 0;
    }
    if (reader->over) {
        reader->cut = reader->cut || reader->length == FIO_LINE_MOST;
        return false;
    }
    if (!reader->escaped && c == '\\') {
        reader->escaped = true;
        return false;
    }
    if (!reader->escaped && c == ';') {
        reader->over = true;
        return false;
    }
    reader->escaped = false;
    if (c == '\b') { /* Marlin rubs out */
        reader->length -= reader->length > 0;
        return false;
    }
    if (reader->length == 0 && (c == ' ' || c == '\t'))
        return false;
    reader->text[reader->length++] = c ? c : '?'; /* the text's end is a 0 */
    reader->over = reader->length == FIO_LINE_MOST;
    return false;
}

/* States: the letters seen so far. A line that is none of these is passed over to its end. */
enum {
    START,
    NUMBER,
    M,
    M1,
    M10,
    M11,
    M4,
    M41,
    M8,
    M87,
    M876,
    M876S,
    BREAK,
    KILL,
    STOP,
    ANSWER,
    SKIP
};

static int step(int state, char c) {
    static const struct {
        char from, byte, to;
    } steps[] = {
        {START, ' ', START},   {START, 'N', NUMBER},  {START, 'M', M},   {NUMBER, 'M', M},
        {NUMBER, ' ', NUMBER}, {NUMBER, '-', NUMBER}, {M, ' ', M},       {M, '1', M1},
        {M, '4', M4},          {M, '8', M8},          {M1, '0', M10},    {M1, '1', M11},
        {M10, '8', BREAK},     {M11, '2', KILL},      {M4, '1', M41},    {M41, '0', STOP},
        {M8, '7', M87},        {M87, '6', M876},      {M876, ' ', M876}, {M876, 'S', M876S},
        {M876S, ' ', M876S},
    };
    if (state == NUMBER && c >= '0' && c <= '9')
        return NUMBER;
    if (state >= BREAK && state <= ANSWER)
        return state; /* whatever follows, as in Marlin */
    for (unsigned i = 0; i < sizeof steps / sizeof *steps; i++)
        if (steps[i].from == state && steps[i].byte == c)
            return steps[i].to;
    return SKIP;
}

fio_emergency fio_emergency_feed(fio_emergency_parser *parser, char c) {
    int state = parser->state;
    if (c == '\n' || c == '\r') {
        parser->state = START;
        return state == BREAK    ? FIO_EMERGENCY_BREAK
               : state == KILL   ? FIO_EMERGENCY_KILL
               : state == STOP   ? FIO_EMERGENCY_STOP
               : state == ANSWER ? FIO_EMERGENCY_ANSWER
                                 : FIO_EMERGENCY_NONE;
    }
    if (state == M876S && c >= '0' && c <= '9') {
        parser->choice = c - '0';
        parser->state = ANSWER;
        return FIO_EMERGENCY_NONE;
    }
    parser->state = state == SKIP ? SKIP : step(state, c);
    return FIO_EMERGENCY_NONE;
}
