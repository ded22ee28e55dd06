"""What _tetcast.py says of the C interface is what the headers say: sizes, places and names of fields, constants,
parameters. A header that was changed without it fails here."""

import ast
import ctypes
import os
import re
import shlex
import subprocess
import tempfile
import unittest

import _tetcast as c
from support import SOURCE

HEADERS = ["tetcast.h", "tetcast_image.h", "tetcast_look.h", "tetcast_figure.h", "tetcast_probe.h"]


def header_text():
    text = ""
    for name in HEADERS:
        with open(os.path.join(SOURCE, "src", name)) as file:
            text += file.read()
    return re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)


def measure(lines):
    """Runs a C program that prints each of the expressions, as a list of numbers."""
    with tempfile.TemporaryDirectory() as folder:
        source, program = os.path.join(folder, "a.c"), os.path.join(folder, "a.out")
        with open(source, "w") as file:
            file.write("#include <stdio.h>\n#include <tetcast.h>\nint main(void)\n{\n")
            file.writelines(f'    printf("%lld\\n", (long long)({line}));\n' for line in lines)
            file.write("    return 0;\n}\n")
        compiler = shlex.split(os.environ.get("CC", "cc"))
        subprocess.run([*compiler, "-std=c11", "-I", os.path.join(SOURCE, "src"), source, "-o", program], check=True)
        return [int(n) for n in subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()]


def fields_of(text, struct):
    """Names of a struct's fields in the header, in order."""
    body = re.search(r"struct " + struct + r"\s*\{(.*?)\}\s*(?:" + struct + r")?\s*;", text, re.S).group(1)
    names = []
    for declaration in filter(str.strip, body.split(";")):
        pointer = re.search(r"\(\*\s*(\w+)\)", declaration)  # to a function or an array
        if pointer:
            names.append(pointer.group(1))
        else:
            names += [re.sub(r"\[.*", "", part).split()[-1].strip("* ") for part in declaration.split(",")]
    return names


def kind_of(parameter):
    """"pointer", or the type's name without what is no type."""
    if "*" in parameter or "[" in parameter:
        return "pointer"
    words = [word for word in parameter.split() if word != "const"]
    return words[0] if words else ""


class Headers(unittest.TestCase):
    def test_structs_have_other_sizes_or_offsets_than_in_the_headers(self):
        wanted, lines = [], []
        for struct in c.STRUCTS:
            name = struct.__name__
            wanted.append((name, ctypes.sizeof(struct)))
            lines.append(f"sizeof({name})")
            for field, _ in struct._fields_:
                at = getattr(struct, field)
                wanted += [(f"offset of {name}.{field}", at.offset), (f"size of {name}.{field}", at.size)]
                lines += [f"offsetof({name}, {field})", f"sizeof((({name} *)0)->{field})"]
        for (what, here), there in zip(wanted, measure(lines)):
            self.assertEqual(here, there, what)

    def test_a_struct_has_other_fields_than_in_the_headers(self):
        text = header_text()
        for struct in c.STRUCTS:
            with self.subTest(struct=struct.__name__):
                self.assertEqual([name for name, _ in struct._fields_], fields_of(text, struct.__name__))

    def test_constants_have_other_values_than_in_the_headers(self):
        for (name, here), there in zip(c.CONSTANTS.items(), measure(c.CONSTANTS)):
            self.assertEqual(here, there, name)

    def test_functions_have_other_parameters_than_in_the_headers(self):
        text = header_text()
        kinds = {ctypes.c_double: {"double"}, ctypes.c_size_t: {"size_t", "uint64_t"}, ctypes.c_uint64: {"size_t", "uint64_t"},
                 ctypes.c_int: {"int", "tc_association"}}
        for name, (result, *arguments) in c.FUNCTIONS.items():
            with self.subTest(function=name):
                found = re.search(r"TC_API\s+([^;(]*?)\b" + name + r"\s*\(([^;]*)\)\s*;", text)
                self.assertIsNotNone(found, "not in the headers")
                returned = found.group(1).strip()
                parameters = [part for part in found.group(2).split(",") if part.strip() != "void"]
                self.assertEqual(len(parameters), len(arguments), parameters)
                for parameter, argument in zip(parameters, arguments):
                    kind = kind_of(parameter)
                    self.assertIn(kind, kinds.get(argument, {"pointer"}), parameter)
                by_result = {None: "void", ctypes.c_int: "tc_status", ctypes.c_double: "double"}
                self.assertEqual(by_result.get(result, "pointer"), kind_of(returned), returned)

    def test_another_field_in_a_header_is_not_noticed(self):
        text = "typedef struct tc_knot { double s, *r[3]; const char *const *name; void (*f)(int a, int b); } tc_knot;"
        self.assertEqual(fields_of(text, "tc_knot"), ["s", "r", "name", "f"])

    def test_python_3_9_cannot_read_the_module(self):
        for name in ("tetcast.py", "_tetcast.py"):
            with open(os.path.join(SOURCE, "src", "python", name)) as file:
                ast.parse(file.read(), name, feature_version=(3, 9))

    def test_the_module_is_for_another_version_than_the_header(self):
        with open(os.path.join(SOURCE, "src", "tetcast.h")) as file:
            version = re.search(r'TC_VERSION_STRING "(\d+\.\d+)\.', file.read()).group(1)
        self.assertEqual(version, c.VERSION)


if __name__ == "__main__":
    unittest.main()
