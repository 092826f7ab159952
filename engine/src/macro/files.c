/* Keys of configuration files that are no options of ours. */
#include <string.h>

#include "config/foreign.h"
#include "macro/names.h"

typedef enum key_kind {
    KEY_BOOL,
    KEY_INTEGER,
    KEY_NUMBER,
    KEY_PERCENT,
    KEY_RELATIVE,
    KEY_TEXT,
    KEY_WORD,
    KEY_BOOLS,
    KEY_INTEGERS,
    KEY_NUMBERS,
    KEY_PERCENTS,
    KEY_POINTS,
    KEY_TEXTS,
    KEY_GUESSED
} key_kind;

typedef struct known_key {
    const char *key;
    key_kind kind;
    const char *initial;
} known_key;

static const known_key known[] = {
#define ISO_KEY(key, kind, initial) {#key, KEY_##kind, initial},
#include "macro/keys.inl"
#undef ISO_KEY
};

enum { KNOWN_COUNT = sizeof known / sizeof *known };

static const known_key *find_known(const char *key) {
    int low = 0, high = KNOWN_COUNT;
    while (low < high) {
        int middle = (low + high) / 2, order = strcmp(known[middle].key, key);
        if (order == 0)
            return &known[middle];
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

bool iso_macro_is_text_list(const char *key) {
    const known_key *row = find_known(key);
    return row && row->kind == KEY_TEXTS;
}

/* ---- one value ---- */

typedef struct slice {
    const char *text;
    int32_t count;
} slice;

static slice trimmed(const char *begin, const char *end) {
    while (begin < end && *begin == ' ')
        begin++;
    while (end > begin && end[-1] == ' ')
        end--;
    return (slice){begin, (int32_t)(end - begin)};
}

static bool same(slice text, const char *word) {
    return (size_t)text.count == strlen(word) && memcmp(text.text, word, strlen(word)) == 0;
}

/* A number with its sign and its %; kind NONE if it is none. */
static iso_datum number_of(slice text) {
    iso_datum number = {.kind = ISO_DATUM_NONE}, read;
    int32_t used, sign = text.count > 0 && (text.text[0] == '-' || text.text[0] == '+');
    if (!iso_datum_read_number(&read, text.text + sign, text.count - sign, &used))
        return number;
    used += sign;
    bool percent = used + 1 == text.count && text.text[used] == '%';
    if (used + percent != text.count)
        return number;
    number = read;
    number.percent = percent;
    if (sign && text.text[0] == '-' && read.kind == ISO_DATUM_INTEGER)
        number.integer = -read.integer;
    else if (sign && text.text[0] == '-')
        number.number = -read.number;
    return number;
}

static iso_datum as_kind(slice text, key_kind kind) {
    iso_datum number = number_of(text);
    if (same(text, "nil"))
        return (iso_datum){.kind = ISO_DATUM_NIL};
    if (number.kind == ISO_DATUM_NONE)
        return iso_datum_text(text.text, text.count);
    bool whole = kind == KEY_INTEGER || kind == KEY_INTEGERS;
    if (kind == KEY_BOOL || kind == KEY_BOOLS)
        return iso_datum_bool(iso_datum_as_number(&number) != 0);
    if (!whole && kind != KEY_GUESSED && number.kind == ISO_DATUM_INTEGER) {
        double value = number.integer;
        bool percent = number.percent;
        number = iso_datum_number(value);
        number.percent = percent;
    }
    number.relative = kind == KEY_RELATIVE && (number.percent || number.number == 0);
    return number;
}

/* "1x2" */
static iso_datum point_of(slice text) {
    const char *cross = memchr(text.text, 'x', (size_t)text.count);
    if (!cross)
        return iso_datum_text(text.text, text.count);
    iso_datum x = number_of(trimmed(text.text, cross));
    iso_datum y = number_of(trimmed(cross + 1, text.text + text.count));
    if (x.kind == ISO_DATUM_NONE || y.kind == ISO_DATUM_NONE)
        return iso_datum_text(text.text, text.count);
    return (iso_datum){.kind = ISO_DATUM_POINT,
                       .point = {iso_datum_as_number(&x), iso_datum_as_number(&y)}};
}

/* \n \r \t are what they are in C; any other character behind a \ is itself. */
static iso_status unescape(iso_datum *value, iso_macro_run *run, slice text) {
    void *room;
    int32_t count = 0;
    *value = iso_datum_text(text.text, text.count);
    if (text.count == 0 || !memchr(text.text, '\\', (size_t)text.count))
        return ISO_OK;
    ISO_TRY(macro_push(&room, run, (size_t)text.count));
    char *to = room;
    for (int32_t i = 0; i < text.count; i++) {
        char c = text.text[i];
        if (c == '\\' && i + 1 < text.count) {
            c = text.text[++i];
            c = (char)(c == 'n' ? '\n' : c == 'r' ? '\r' : c == 't' ? '\t' : c);
        }
        to[count++] = c;
    }
    *value = iso_datum_text(to, count);
    return ISO_OK;
}

/* ---- lists ---- */

/* Behind the item that begins at `at`. */
static const char *item_end(const char *at, char separator) {
    bool quoted = false;
    for (; *at && (quoted || *at != separator); at++) {
        if (quoted && *at == '\\' && at[1])
            at++;
        else if (*at == '"' && separator == ';')
            quoted = !quoted;
    }
    return at;
}

static iso_status item_of(iso_datum *value, iso_macro_run *run, slice text, key_kind kind) {
    if (kind == KEY_POINTS) {
        *value = point_of(text);
        return ISO_OK;
    }
    if (kind != KEY_TEXTS) {
        *value = as_kind(text, kind);
        return ISO_OK;
    }
    if (text.count >= 2 && text.text[0] == '"' && text.text[text.count - 1] == '"')
        return unescape(value, run, (slice){text.text + 1, text.count - 2});
    *value = iso_datum_text(text.text, text.count);
    return ISO_OK;
}

static iso_status list_of(iso_datum *value, iso_macro_run *run, const char *text, key_kind kind) {
    char separator = kind == KEY_TEXTS ? ';' : ',';
    int32_t count = *text != 0;
    for (const char *at = item_end(text, separator); *at; at = item_end(at + 1, separator))
        count++;
    if (count > MACRO_LIST_MAX)
        return macro_fail(run, run->token.begin, "the list has more than %d values",
                          MACRO_LIST_MAX);
    void *room;
    ISO_TRY(macro_push(&room, run, (size_t)count * sizeof(iso_datum)));
    for (int32_t i = 0; i < count; i++) {
        const char *end = item_end(text, separator);
        ISO_TRY(item_of((iso_datum *)room + i, run, trimmed(text, end), kind));
        text = *end ? end + 1 : end;
    }
    *value = iso_datum_list(room, count);
    return ISO_OK;
}

/* Of keys nobody told us about: a number, a list of numbers or of quoted texts, or a text. */
static iso_status guess(iso_datum *value, iso_macro_run *run, const char *text) {
    if (*text == '"')
        return list_of(value, run, text, KEY_TEXTS);
    *value = as_kind(trimmed(text, text + strlen(text)), KEY_GUESSED);
    if (value->kind != ISO_DATUM_TEXT)
        return ISO_OK;
    const char *end = item_end(text, ',');
    if (*end && number_of(trimmed(text, end)).kind != ISO_DATUM_NONE)
        return list_of(value, run, text, KEY_GUESSED);
    return unescape(value, run, (slice){text, (int32_t)strlen(text)});
}

static iso_status value_of(iso_datum *value, iso_macro_run *run, const char *text, key_kind kind) {
    slice whole = {text, (int32_t)strlen(text)};
    if (kind == KEY_GUESSED)
        return guess(value, run, text);
    if (kind >= KEY_BOOLS)
        return list_of(value, run, text, kind);
    if (kind == KEY_TEXT)
        return unescape(value, run, whole);
    *value = kind == KEY_WORD ? iso_datum_text(text, whole.count) : as_kind(whole, kind);
    return ISO_OK;
}

/* Presets go by these names, too; and by the first extruder's type. */
static const struct {
    const char *key, *is;
} aliases[] = {{"print_preset", "print_settings_id"},
               {"printer_preset", "printer_settings_id"},
               {"filament_preset", "filament_settings_id"}};

iso_status names_of_files(iso_datum *value, iso_macro_run *run, const char *key) {
    for (size_t i = 0; i < sizeof aliases / sizeof *aliases; i++)
        if (strcmp(key, aliases[i].key) == 0)
            key = aliases[i].is;
    const known_key *row = find_known(key);
    const char *text =
        run->scope->options ? iso_foreign_get(&run->scope->options->foreign, key) : NULL;
    if (text)
        return value_of(value, run, text, row ? row->kind : KEY_GUESSED);
    return row ? value_of(value, run, row->initial, row->kind) : ISO_OK;
}
