"""Prints the public interface of a crate, one line an item, from rustdoc's JSON.

    python3 .ci/public_api.py target/doc/bowden.json

Items appear under the path by which a user reaches them, with their signature. Impls of traits that
the compiler derives or gives to every type are one line a type. Exit status 77: a form of the JSON
that this file does not know.
"""

import json
import sys

KNOWN = range(45, 60)


def generics_of(args):
    if not args:
        return ""
    if "angle_bracketed" in args:
        inner = args["angle_bracketed"]
        parts = [generic_arg(one) for one in inner["args"]]
        parts += [constraint(one) for one in inner["constraints"]]
        return f"<{', '.join(parts)}>" if parts else ""
    if "parenthesized" in args:
        inner = args["parenthesized"]
        result = f" -> {kind(inner['output'])}" if inner["output"] else ""
        return f"({', '.join(map(kind, inner['inputs']))}){result}"
    return ""


def generic_arg(arg):
    if "lifetime" in arg:
        return arg["lifetime"]
    if "type" in arg:
        return kind(arg["type"])
    if "const" in arg:
        return arg["const"].get("expr", "?")
    return "_"


def constraint(one):
    binding = one["binding"]
    if "equality" in binding:
        equal = binding["equality"]
        return f"{one['name']} = {kind(equal['type']) if 'type' in equal else equal['constant']['expr']}"
    return f"{one['name']}: {bounds(binding['constraint'])}"


def bounds(all_bounds):
    texts = []
    for bound in all_bounds:
        if "trait_bound" in bound:
            one = bound["trait_bound"]
            mark = "?" if one["modifier"] == "maybe" else ""
            texts.append(mark + one["trait"]["path"].split("::")[-1] + generics_of(one["trait"]["args"]))
        elif "outlives" in bound:
            texts.append(bound["outlives"])
    return " + ".join(texts)


def kind(of):
    """A type as it is written."""
    if of is None:
        return "()"
    if of == "infer":
        return "_"
    ((name, inner),) = of.items()
    if name == "resolved_path":
        return inner["path"].split("::")[-1] + generics_of(inner["args"])
    if name in ("generic", "primitive"):
        return inner
    if name == "borrowed_ref":
        lifetime = f"{inner['lifetime']} " if inner["lifetime"] else ""
        return f"&{lifetime}{'mut ' if inner['is_mutable'] else ''}{kind(inner['type'])}"
    if name == "tuple":
        return f"({', '.join(map(kind, inner))})"
    if name == "slice":
        return f"[{kind(inner)}]"
    if name == "array":
        return f"[{kind(inner['type'])}; {inner['len']}]"
    if name == "qualified_path":
        trait = inner["trait"]
        owner = kind(inner["self_type"])
        if not trait or not trait["path"]:
            return f"{owner}::{inner['name']}"
        return f"<{owner} as {trait['path'].split('::')[-1]}{generics_of(trait['args'])}>::{inner['name']}"
    if name == "impl_trait":
        return f"impl {bounds(inner)}"
    if name == "dyn_trait":
        return "dyn " + " + ".join(one["trait"]["path"].split("::")[-1] for one in inner["traits"])
    if name == "function_pointer":
        return "fn" + signature(inner["sig"])
    return name


def parameters(generics):
    """`<T: Real, const N: usize>` and the where clause."""
    texts = []
    for one in generics["params"]:
        ((form, inner),) = one["kind"].items()
        if form == "lifetime":
            texts.append(one["name"])
        elif form == "const":
            texts.append(f"const {one['name']}: {kind(inner['type'])}")
        elif not inner.get("is_synthetic"):
            bound = bounds(inner["bounds"])
            texts.append(f"{one['name']}: {bound}" if bound else one["name"])
    clauses = [
        f"{kind(one['bound_predicate']['type'])}: {bounds(one['bound_predicate']['bounds'])}"
        for one in generics["where_predicates"]
        if "bound_predicate" in one
    ]
    return (f"<{', '.join(texts)}>" if texts else "", f" where {', '.join(clauses)}" if clauses else "")


def signature(sig):
    inputs = []
    for name, of in sig["inputs"]:
        written = kind(of)
        if name == "self":
            inputs.append(written.replace("Self", "self"))
        else:
            inputs.append(f"{name}: {written}")
    result = f" -> {kind(sig['output'])}" if sig["output"] else ""
    return f"({', '.join(inputs)}){result}"


class Listing:
    """All lines of a crate."""

    def __init__(self, crate):
        self.index = {str(key): item for key, item in crate["index"].items()}
        self.lines = set()
        self.done = set()
        self.open_ended = False

    def item(self, number):
        return self.index.get(str(number))

    def add(self, path, text):
        self.lines.add(f"{path}{text}")

    def walk(self, number, path):
        item = self.item(number)
        if item is None or (number, path) in self.done:
            return
        self.done.add((number, path))
        ((form, inner),) = item["inner"].items()
        if form == "use":
            target = self.item(inner["id"]) if inner["id"] is not None else None
            if target is None:
                self.add(f"{path}::{inner['name']}", f" = {inner['source']}")
            elif inner["is_glob"]:
                ((_, module),) = target["inner"].items()
                for one in module.get("items", module.get("variants", [])):
                    self.walk(one, path)
            else:
                self.named(target, f"{path}::{inner['name']}")
        elif form == "module":
            below = f"{path}::{item['name']}" if path else item["name"]
            self.add(below, " (module)")
            for one in inner["items"]:
                self.walk(one, below)
        elif form != "impl" and item["name"]:
            self.named(item, f"{path}::{item['name']}")

    def named(self, item, path):
        ((form, inner),) = item["inner"].items()
        if form == "module":
            for one in inner["items"]:
                self.walk(one, path)
        elif form == "function":
            self.function(item, path)
        elif form in ("struct", "enum"):
            self.open_ended = any("non_exhaustive" in str(one) for one in item["attrs"])
            self.data(form, inner, path)
        elif form == "trait":
            given, where = parameters(inner["generics"])
            above = f": {bounds(inner['bounds'])}" if inner["bounds"] else ""
            self.add(path, f"{given}{above}{where} (trait)")
            for one in inner["items"]:
                self.member(one, path)
        elif form == "constant":
            self.add(path, f": {kind(inner['type'])} (constant)")
        elif form == "type_alias":
            self.add(path, f"{parameters(inner['generics'])[0]} = {kind(inner['type'])}")
        elif form == "macro":
            self.add(path, "! (macro)")

    def function(self, item, path):
        inner = item["inner"]["function"]
        given, where = parameters(inner["generics"])
        constant = "const " if inner["header"]["is_const"] else ""
        self.add(path, f"{given}{signature(inner['sig'])}{where} ({constant}fn)")

    def data(self, form, inner, path):
        given, where = parameters(inner["generics"])
        mark = "non_exhaustive " if self.open_ended else ""
        self.add(path, f"{given}{where} ({mark}{form})")
        if form == "struct":
            fields = inner["kind"]
            if isinstance(fields, dict):
                of = fields.get("plain", {}).get("fields", fields.get("tuple", []))
                for one in of:
                    self.member(one, path)
        for one in inner.get("variants", []):
            variant = self.item(one)
            name = f"{path}::{variant['name']}"
            self.add(name, " (variant)")
            form_of = variant["inner"]["variant"]["kind"]
            if isinstance(form_of, dict):
                for field in form_of.get("struct", {}).get("fields", form_of.get("tuple", [])):
                    self.member(field, name)
        derived = set()
        for number in inner["impls"]:
            self.implementation(number, path, derived)
        if derived:
            self.add(path, " implements " + ", ".join(sorted(derived)))

    def implementation(self, number, path, derived):
        item = self.item(number)
        if item is None:
            return
        impl = item["inner"]["impl"]
        if impl["is_synthetic"] or impl["blanket_impl"]:
            return
        if impl["trait"]:
            trait = impl["trait"]
            name = trait["path"].split("::")[-1]
            if name != "StructuralPartialEq":
                derived.add(name + generics_of(trait["args"]))
            return
        # An interface that is there for one float alone is not the same one.
        whom = kind(impl["for"])
        special = whom[whom.index("<") :] if "<f32" in whom or "<f64" in whom else ""
        for one in impl["items"]:
            self.member(one, path + special)

    def member(self, number, path):
        item = self.item(number)
        if item is None:
            return
        ((form, inner),) = item["inner"].items()
        name = f"{path}::{item['name']}"
        if form == "function":
            self.function(item, name)
        elif form == "struct_field":
            self.add(name, f": {kind(inner)} (field)")
        elif form == "assoc_const":
            self.add(name, f": {kind(inner['type'])} (constant)")
        elif form == "assoc_type":
            self.add(name, f": {bounds(inner['bounds'])} (type)")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        crate = json.load(file)
    if crate["format_version"] not in KNOWN:
        print(f"rustdoc's JSON has the form {crate['format_version']}", file=sys.stderr)
        sys.exit(77)
    listing = Listing(crate)
    listing.walk(crate["root"], "")
    # A module of documentation alone cannot be used.
    used = {line for line in listing.lines if not line.endswith(" (module)")}
    modules = {line for line in listing.lines if line.endswith(" (module)")}
    modules = {one for one in modules if any(line.startswith(one.split()[0] + "::") for line in used)}
    print("\n".join(sorted(used | modules)))


main()
