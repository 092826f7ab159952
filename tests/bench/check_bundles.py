#!/usr/bin/env python3
"""check_bundles.py ISOSLICE FOLDER: slice a small part with every printer of PrusaSlicer's bundles.

The bundles are those of Debian's prusa-slicer package: installed ones, else fetched into FOLDER by
apt-get. Each printer gets the print and the filament that its bundle names for it, or the first
that say they fit. All its G-code texts must evaluate (isoslice refuses the job else), and values of
the bundle must be usable. If prusa-slicer is installed, texts of a sample of printers are compared
with what it writes for the same values.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

INSTALLED = pathlib.Path("/usr/share/PrusaSlicer/profiles")
TEXTS = ["start_gcode", "end_gcode", "before_layer_gcode", "layer_gcode", "start_filament_gcode",
         "end_filament_gcode", "between_objects_gcode"]
COMPARED = TEXTS[:6]
SAMPLE = 5  # every fifth printer is compared

CUBE = [(x, y, z) for z in (0, 2) for y in (0, 10) for x in (0, 10)]
FACES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7),
         (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def write_part(path):
    with open(path, "w") as out:
        out.write("solid part\n")
        for face in FACES:
            out.write("facet normal 0 0 0\nouter loop\n")
            out.writelines("vertex %g %g %g\n" % CUBE[i] for i in face)
            out.write("endloop\nendfacet\n")
        out.write("endsolid part\n")


# --- bundles ------------------------------------------------------------------------------------

def find_bundles(folder):
    if INSTALLED.is_dir():
        return INSTALLED
    profiles = folder / "prusa" / INSTALLED.relative_to("/")
    if not profiles.is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        fetched = subprocess.run(["apt-get", "download", "-qq", "-o", "APT::Sandbox::User=root",
                                  "prusa-slicer"], cwd=folder)
        if fetched.returncode:
            print("no bundles: prusa-slicer is neither installed nor to be had from apt; skipped")
            sys.exit(0)
        package = next(folder.glob("prusa-slicer_*.deb"))
        subprocess.run(["dpkg-deb", "-x", package, folder / "prusa"], check=True)
        package.unlink()
    return profiles


def read_bundle(path):
    sections, current = {}, None
    for raw in path.read_text(encoding="utf-8-sig").splitlines():
        line = raw.strip()
        if not line or line[0] in "#;":
            continue
        if line[0] == "[" and line[-1] == "]":
            current = sections.setdefault(line[1:-1].strip(), {})
        elif current is not None and "=" in line:
            key, _, value = line.partition("=")
            current[key.strip()] = value.strip()
    return sections


def flatten(sections, name, depth=0):
    """A section with its parents' lines."""
    values = {}
    own = sections.get(name)
    if own is None or depth > 30:
        return values
    kind = name.split(":")[0]
    for parent in own.get("inherits", "").strip('"').split(";"):
        if parent.strip():
            values.update(flatten(sections, f"{kind}:{parent.strip()}", depth + 1))
    values.update(own)
    return values


# --- what fits a printer ------------------------------------------------------------------------

NAME = r"([a-z_]\w*)(?:\[(\w+)\])?"


def unescape(text):
    return re.sub(r"\\(.)", lambda m: {"n": "\n", "r": "\r", "t": "\t"}.get(m[1], m[1]), text)


def holds(condition, values):
    """compatible_printers_condition, by Python's own means."""
    def value(name):
        text = values.get(name, "")
        if name == "single_extruder_multi_material":
            return text == "1"
        if name == "num_extruders":
            return len(values.get("nozzle_diameter", "0.4").split(","))
        first = text.split(",")[0]
        try:
            return float(first)
        except ValueError:
            return unescape(text)

    def matches(name, expression):
        return re.fullmatch(expression, str(value(name)), re.S) is not None

    code = condition.strip('"')
    texts = []

    def keep(match):
        texts.append(match[0])
        return f"T{len(texts) - 1}_"

    code = re.sub(NAME + r"\s*([=!])~\s*/((?:[^/\\]|\\.)*)/",
                  lambda m: keep([f"({'not ' * (m[3] == '!')}matches({m[1]!r}, {m[4]!r}))"]), code)
    code = re.sub(r'"[^"]*"', keep, code)
    code = code.replace("&&", " and ").replace("||", " or ")
    code = re.sub(r"!(?!=)", " not ", code)
    code = re.sub(r"\b(?!T\d+_|and\b|or\b|not\b)" + NAME, lambda m: f"value({m[1]!r})", code)
    code = re.sub(r"T(\d+)_", lambda m: texts[int(m[1])], code)
    try:
        return bool(eval(code, {"value": value, "matches": matches}))
    except Exception as error:  # a condition that we can't read fits nobody
        print(f"  condition not understood: {condition}: {error}")
        return False


def choose(sections, flat, kind, printer, wanted):
    """The section of that kind that the printer names, or the first that fits it."""
    if f"{kind}:{wanted}" in sections:
        return wanted
    for name in sections:
        if name.startswith(kind + ":") and "*" not in name:
            values = flat(name)
            condition = values.get("compatible_printers_condition", "")
            if condition and holds(condition, printer):
                return name[len(kind) + 1:]
    return None


# --- what both slicers write --------------------------------------------------------------------

def quote_marked(key, value):
    """A text between lines that mark it."""
    is_list = key.endswith("filament_gcode")
    if is_list:
        match = re.match(r'"((?:[^"\\]|\\.)*)"', value)
        value = match[1] if match else value
    marked = f";<{key}>\\n{value}\\n;</{key}>"
    return f'"{marked}"' if is_list else marked


def marked_texts(gcode):
    """The texts of a G-code file, in order; of layers the first three."""
    found = {}
    for match in re.finditer(r"^;<(\w+)>\n(.*?)\n?;</\1>$", gcode, re.S | re.M):
        found.setdefault(match[1], []).append(match[2])
    return {key: texts[:3] for key, texts in found.items()}


def plain(text):
    """Without what either adds to the lines: blank lines, spaces at ends, progress."""
    lines = (line.rstrip() for line in text.split("\n"))
    return [line for line in lines if line and not line.startswith("M73")]


def compare(isoslice, values, scratch, part):
    """How many texts were compared, and those that differ, as (key, ours, theirs); None if
    prusa-slicer can't."""
    lines = dict(values)
    for key in ("inherits", "compatible_printers_condition", "compatible_prints_condition",
                "renamed_from", "post_process", "thumbnails"):
        lines.pop(key, None)
    for key in COMPARED:
        lines[key] = quote_marked(key, lines.get(key, ""))
    # In codes of the end PrusaSlicer's layer_z is that of the lifted nozzle; here, of the layer.
    lines.update(retract_lift="0", filament_retract_lift="nil")
    lines.update(skirts="0", brim_width="0", complete_objects="0", support_material="0",
                 raft_layers="0", wipe_tower="0", gcode_label_objects="0", arc_fitting="disabled")
    ini = scratch / "flat.ini"
    ini.write_text("".join(f"{key} = {value}\n" for key, value in lines.items()))
    theirs, ours = scratch / "theirs.gcode", scratch / "ours.gcode"
    theirs.unlink(missing_ok=True)
    run = subprocess.run(["prusa-slicer", "-g", "--load", ini, part, "-o", theirs],
                         capture_output=True, text=True)
    if run.returncode or not theirs.exists():
        return None
    run = subprocess.run([isoslice, "-c", ini, part, "-o", ours, "--quiet"], capture_output=True,
                         text=True)
    if run.returncode:
        return 0, [("isoslice", run.stderr.strip(), "")]
    a, b = marked_texts(ours.read_text()), marked_texts(theirs.read_text())
    count = sum(len(texts) for texts in b.values())
    return count, [(key, a.get(key), b.get(key)) for key in COMPARED
                   if [plain(t) for t in a.get(key, [])] != [plain(t) for t in b.get(key, [])]]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    isoslice, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    bundles = find_bundles(folder)
    peer = shutil.which("prusa-slicer")
    printers = texts = macros = compared = blocks = uncomparable = 0
    failures, differences = [], []
    with tempfile.TemporaryDirectory() as scratch_name:
        scratch = pathlib.Path(scratch_name)
        part = scratch / "part.stl"
        write_part(part)
        for path in sorted(bundles.glob("*.ini")):
            sections, known = read_bundle(path), {}

            def flat(name):
                if name not in known:
                    known[name] = flatten(sections, name)
                return known[name]

            for section in sections:
                if not section.startswith("printer:") or "*" in section:
                    continue
                printer = flat(section)
                if printer.get("printer_technology") == "SLA":
                    continue
                name = section[len("printer:"):]
                first = printer.get("default_filament_profile", "").split(";")[0].strip('"')
                chosen = {"print": choose(sections, flat, "print", printer,
                                          printer.get("default_print_profile", "")),
                          "filament": choose(sections, flat, "filament", printer, first)}
                values, choice = {}, f"{path}:{section}"
                for kind, preset in chosen.items():
                    if preset:
                        values.update(flat(f"{kind}:{preset}"))
                        values["filament_settings_id" if kind == "filament" else
                               "print_settings_id"] = preset
                        choice += f":{kind}:{preset}"
                values.update(printer)
                values["printer_settings_id"] = name
                printers += 1
                for key in TEXTS:
                    texts += bool(values.get(key))
                    macros += len(re.findall(r"[\[{]", values.get(key, "")))
                run = subprocess.run([isoslice, "-c", choice, part, "-o", scratch / "o.gcode",
                                      "--quiet"], capture_output=True, text=True)
                if run.returncode:
                    failures.append(f"{path.name}, {name}: {run.stderr.strip()}")
                elif peer and printers % SAMPLE == 0:
                    result = compare(isoslice, values, scratch, part)
                    if result is None:
                        uncomparable += 1
                        continue
                    compared += 1
                    blocks += result[0]
                    differences += [(path.name, name, *d) for d in result[1]]
    print(f"{printers} printers, {texts} texts with {macros} macros: {len(failures)} failed")
    for failure in failures:
        print("  " + failure)
    if peer:
        print(f"{compared} compared with {peer}: of {blocks} texts {len(differences)} differ "
              f"({uncomparable} printers it refused)")
        for bundle, name, key, ours, theirs in differences:
            print(f"  {bundle}, {name}: {key}\n    ours:   {ours!r:.600}\n"
                  f"    theirs: {theirs!r:.600}")
    sys.exit(1 if failures or differences else 0)


if __name__ == "__main__":
    main()
