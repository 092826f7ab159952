/* Numbered lines that no single flipped bit turns into others.
 *
 * What one flipped bit can do to "N5 body*33" LF, and why nothing wrong is ever executed:
 *
 * - A byte before the '*' becomes another one that stays in the line: the sum differs in that bit.
 *   That it becomes a backslash or a backspace removes one byte b, or two, a and b, from the sum;
 *   b is not 0, and a = b only for "HH" ('H' is one bit from a backspace), which occurs in texts
 *   alone and is written "Hh" there.
 * - It becomes LF or CR, `;`, NUL or (where parentheses are comments) '(': the first part has a
 *   number but no checksum, and is rejected. What follows an LF or CR is a line of its own, with
 *   no number. It starts with what followed an 'M', 'J' or '-' ('*' too, but then it is a number):
 *   the digits of a value, never a command, save in texts. There those letters are written 'm',
 *   'j', '_' where a command's letter follows (8a and 8d, of UTF-8, '?'). A tab is sent as a blank.
 * - Bytes that the firmware leaves out of the line, and so of the sum, even unharmed: a backslash
 * is written '/', and parentheses as brackets. Commands with a ';' or a control byte are refused.
 * - The '*' becomes anything else: no checksum, rejected. (A text has no '*' of its own: Marlin
 *   would end it there, so it becomes '+'.)
 * - A digit of the checksum: its value changes, or it ends early, which also changes it, since it
 *   is written without leading zeros. Only "*0" with its 0 gone still is 0: the right sum of an
 *   unharmed body.
 * - The 'N': the line is no longer numbered, and no command begins with any of its eight other
 *   values. The next line's number tells that this one is missing.
 * - The LF becomes f, one of 0b 08 0e 02 1a 2a 4a 8a, and what comes next is appended. If that is a
 *   line "N6 next*44", the sum over it all is c ^ '*' ^ digits(c) ^ f ^ 44, where c = 33 is the sum
 *   of the first body: wrong unless c ^ '*' ^ digits(c) ^ f = 0 (without the last digit and f if f
 *   is the backspace 08). Of the 256 values of c these hit 15;
 *   for each of them one of: a blank before the '*' (c ^ 20), a zero before the number (c ^ 30),
 *   both (c ^ 10), leads out. If what follows has no '*' and f is none, the first checksum still
 *   is the right one: line 5 is executed, as it should be, up to its '*'. If f is the last '*', no
 *   number follows it, and c ^ '*' ^ digits(c) is 0 for no c.
 *
 * What remains: two ends of adjacent lines hit at once (three lines in one) pass in about one case
 * of 40, and so does a pair that is longer than the firmware's buffer and cut within the second
 * checksum, in one of 256. Marlin ends the command at the first '*', so that it still executes line
 * 5 as it was sent, and then asks for line 6. A firmware that reads commands in lower case without
 * taking 'n' for 'N' executes a line whose 'N' lost that bit unnumbered, then asks for it again:
 * twice. A bit makes an emergency of M109, M118, M400 and some more, where the firmware obeys those
 * before it looks at the checksum: fio_encode_disguised(); of M110 too, which must stay as it is.
 */
#include "protocol/encode.h"

#include <string.h>

#include "base/text.h"

unsigned fio_checksum(const char *bytes, size_t size) {
    unsigned sum = 0;
    for (size_t i = 0; i < size; i++)
        sum ^= (unsigned char)bytes[i];
    return sum;
}

static int checksum_digits(char digits[4], unsigned sum) {
    int count = 0;
    if (sum >= 100)
        digits[count++] = (char)('0' + sum / 100);
    if (sum >= 10)
        digits[count++] = (char)('0' + sum / 10 % 10);
    digits[count++] = (char)('0' + sum % 10);
    digits[count] = 0;
    return count;
}

/* Whether a body with this sum could pass together with what follows, if one bit of the LF between
 * them were wrong. */
static bool mergeable(unsigned sum) {
    char digits[4];
    int count = checksum_digits(digits, sum);
    unsigned all = sum ^ '*' ^ fio_checksum(digits, (size_t)count);
    unsigned backspaced = sum ^ '*' ^ fio_checksum(digits, (size_t)count - 1);
    if (backspaced == 0)
        return true;
    for (unsigned bit = 1; bit < 256; bit *= 2)
        if (all == ('\n' ^ bit))
            return true;
    return false;
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* The number behind a command's letter, -1 if it has none or is of another letter. */
static int code_of(const char *command, size_t length, char letter) {
    if (length < 2 || (command[0] | 32) != (letter | 32) || !is_digit(command[1]))
        return -1;
    int code = 0;
    for (size_t i = 1; i < length && is_digit(command[i]) && code < 100000; i++)
        code = code * 10 + (command[i] - '0');
    return code;
}

static bool is_shown_text(int code) {
    return code == 117 || code == 118 || code == 0 || code == 1;
}

static bool starts_command(const char *text, size_t length) {
    while (length > 0 && *text == ' ')
        text++, length--;
    return length > 0 && *text && strchr("GMTNgmtn", *text);
}

/* What a bit could turn into a command, or a star, in a text that is shown. */
static void soften(char *text, size_t length) {
    for (size_t i = 0; i < length; i++) {
        bool command = starts_command(text + i + 1, length - i - 1);
        if (text[i] == '*')
            text[i] = '+';
        else if (text[i] == '-' && command)
            text[i] = '_';
        else if ((text[i] == 'J' || text[i] == 'M') && command)
            text[i] |= 32;
        else if (text[i] == 'M' && length - i >= 4 && memcmp(text + i, "M110", 4) == 0)
            text[i] |= 32; /* sets the line number wherever it stands */
        else if (((unsigned char)text[i] == 0x8a || (unsigned char)text[i] == 0x8d) && command)
            text[i] = '?';
        else if (text[i] == 'H' && i > 0 && text[i - 1] == 'H')
            text[i] |= 32;
    }
}

static size_t squeeze(char *text, size_t length) {
    size_t kept = 0;
    for (size_t i = 0; i < length; i++)
        if (text[i] != ' ' && text[i] != '\t')
            text[kept++] = text[i];
    return kept;
}

/* Commands whose argument is not made of words. */
static bool is_free_text(int code) {
    static const short codes[] = {0,   1,   16,  20,  23,  28,  30,  32,  33, 36,
                                  117, 118, 486, 550, 551, 552, 587, 588, 928};
    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
        if (codes[i] == code)
            return true;
    return false;
}

/* What would never arrive as it is; false if it can't be said in another way. */
static bool spell(char *body, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if (body[i] == ';' || ((unsigned char)body[i] < ' ' && body[i] != '\t'))
            return false;
        if (body[i] == '\t')
            body[i] = ' ';
        if (body[i] == '\\')
            body[i] = '/';
        else if (body[i] == '(' || body[i] == ')')
            body[i] = body[i] == '(' ? '[' : ']';
    }
    return true;
}

/* The command in `body`, so that it fits into `room` bytes; 0 if it can't. */
static size_t fit(char *body, const char *command, size_t length, size_t room) {
    char whole[2 * FIO_WIRE_LINE_MOST];
    int code = code_of(command, length, 'M');
    bool shown = is_shown_text(code);
    if (shown && length > room) {
        length = room;
        while (length > 0 && ((unsigned char)command[length] & 0xc0) == 0x80)
            length--; /* no half of a character */
    }
    if (length > sizeof whole)
        return 0;
    memcpy(whole, command, length);
    if (length > room && !is_free_text(code))
        length = squeeze(whole, length);
    if (length > room || !spell(whole, length))
        return 0;
    if (shown) {
        size_t start = 1;
        while (start < length && is_digit(whole[start]))
            start++;
        soften(whole + start, length - start);
    }
    memcpy(body, whole, length);
    return length;
}

/* One of the four ways to write it; 0 if it is too long. */
static size_t write_line(char *wire, int64_t number, const char *command, size_t length,
                         size_t most, bool zero, bool blank) {
    char digits[4];
    fio_text text = fio_text_in(wire, FIO_WIRE_LINE_MOST + 1);
    fio_text_string(&text, zero ? "N0" : "N");
    fio_text_integer(&text, number);
    fio_text_bytes(&text, " ", 1);
    size_t frame = text.length + 4 + blank; /* "*255": the sum is known only later */
    size_t room = most > frame ? most - frame : 0;
    if (room == 0)
        return 0;
    size_t body = fit(wire + text.length, command, length, room);
    if (body == 0)
        return 0;
    text.length += body;
    if (blank)
        fio_text_bytes(&text, " ", 1);
    unsigned sum = fio_checksum(wire, text.length);
    int count = checksum_digits(digits, sum);
    fio_text_bytes(&text, "*", 1);
    fio_text_bytes(&text, digits, (size_t)count);
    fio_text_bytes(&text, "\n", 1);
    return mergeable(sum) ? 0 : text.length;
}

size_t fio_encode_line(char *wire, int64_t number, const char *command, size_t length,
                       size_t most) {
    if (most > FIO_WIRE_LINE_MOST - 1)
        most = FIO_WIRE_LINE_MOST - 1;
    wire[0] = 0;
    if (length == 0 || number < 0)
        return 0;
    for (int way = 0; way < 4; way++) {
        size_t size = write_line(wire, number, command, length, most, way >= 2, way % 2);
        if (size > 0)
            return size;
    }
    wire[0] = 0;
    return 0;
}

/* Three digits, at most one of them with one wrong bit. */
static bool one_bit_apart(const char *digits, const char *other) {
    unsigned differences = 0;
    int bytes = 0;
    for (int i = 0; i < 3; i++)
        if (digits[i] != other[i]) {
            differences = (unsigned)(digits[i] ^ other[i]);
            bytes++;
        }
    return bytes == 1 && (differences & (differences - 1)) == 0;
}

/* Whether one bit makes an emergency of a code that begins with these three digits. */
static bool near_emergency(const char digits[3]) {
    static const char *const emergencies[] = {"108", "112", "410", "876"};
    for (int i = 0; i < 4; i++)
        if (one_bit_apart(digits, emergencies[i]))
            return true;
    return false;
}

size_t fio_encode_disguised(char *text, const char *command, size_t length) {
    size_t zeros = 0;
    text[0] = 0;
    if (length == 0)
        return 0;
    /* M110 is looked for as it is written. */
    int code = code_of(command, length, 'M');
    if (length >= 4 && code >= 100 && code != 110 && is_digit(command[2]) && is_digit(command[3])) {
        char digits[5] = {'0', '0', command[1], command[2], command[3]};
        while (zeros < 2 && near_emergency(digits + 2 - zeros))
            zeros++; /* "M0128" would be an M112 with its 0 hit, "M00128" is none */
    } else if (code == 41) {
        zeros = 1; /* its blank is one bit from a 0 */
    }
    text[0] = command[0];
    memset(text + 1, '0', zeros);
    memcpy(text + 1 + zeros, command + 1, length - 1);
    text[length + zeros] = 0;
    return length + zeros;
}
