"""Checks that declarations used by other libraries have THIMBLE_EXPORT (thimble/driver/export.h), in a static build.

    export_marks.py SOURCE_FOLDER BUILD_FOLDER

A function or class of a public header of the five libraries needs the mark if an archive defines one of its symbols. A
function or class of a private header needs it if another library or the program refers to it. Prints a line for each missing
mark, then the number of checked declarations; the exit code is 1 if a mark is missing.
"""
import collections
import pathlib
import re
import subprocess
import sys

FOLDERS = {'driver': ['driver'], 'device_sim': ['device_sim'], 'render': ['render'], 'scene': ['app/scene', 'app/bag'],
           'session': ['app/session']}
MARK = 'THIMBLE_EXPORT'
KINDS = 'TDBRSGVWu'


def archive(build, library):
    return build / FOLDERS[library][0] / f'libthimble_{library}.a'


def demangled(names):
    names = sorted(names)
    text = subprocess.run(['c++filt'], input='\n'.join(names), capture_output=True, text=True, check=True).stdout
    return dict(zip(names, text.split('\n')))


def symbols(files, kinds, *options):
    """Returns the external symbols of these kinds, as the linker knows them."""
    text = subprocess.run(['nm', '-gP', *options, *map(str, files)], capture_output=True, text=True, check=True).stdout
    return {words[0] for line in text.splitlines() if len(words := line.split()) > 1 and words[1] in kinds}


def without_arguments(name):
    """Returns the name of a demangled function ("thimble::driver::SafetyGate::pass") or, for the tables of a class, the class name
    followed by "::"; and the template arguments in it, as a text."""
    name = re.sub(r'\[abi:\w+\]', '', name)
    table = re.match(r'(?:vtable|typeinfo|typeinfo name|VTT) for (.*)', name)
    if table:
        name = table[1] + '::'
    name = re.sub(r'^(?:guard variable for|(?:non-)?virtual thunk to) ', '', name).replace('(anonymous namespace)', 'hidden')
    name = re.sub(r'operator(\(\)|[^\w\s(]+|\s[^(]*|\[\])(?=\()', 'operator', name)
    arguments, count = '', 1
    while count:  # the innermost first, only before the arguments of the function
        head, bracket, tail = name.partition('(')
        inner = re.findall(r'<([^<>]*)>', head)
        arguments += ' '.join(inner)
        head, count = re.subn(r'<[^<>]*>', '', head)
        name = head + bracket + tail
    return name.split('(', 1)[0].strip().split(' ')[-1], arguments


class Headers:
    """Declarations of headers. With clang-format, declarations in a namespace begin at the start of a line."""

    def __init__(self):
        self.classes = {}                               # name: (marked, public, place)
        self.functions = collections.defaultdict(list)  # name: [(marked, public, place)]

    def read(self, path, public, place):
        blocks, statement = [], ''  # the namespaces around a line; None inside a class or a function
        for number, line in enumerate(path.read_text().split('\n'), 1):
            line = re.sub(r'\s*//.*', '', line)
            if not line.strip() or line.startswith('#'):
                continue
            if not statement:
                if line.startswith('}') and blocks:
                    blocks.pop()
                if line[0] in ' }':
                    continue
                begin = number
            statement = (statement + ' ' + line.strip()).strip()
            if line.endswith('{'):
                namespace = re.match(r'namespace ([\w:]*) ?\{$', statement)
                self.take(statement, blocks, public, f'{place}:{begin}')
                blocks.append(namespace[1] if namespace else None)
                statement = ''
            elif line[-1] in ';}':
                self.take(statement, blocks, public, f'{place}:{begin}')
                statement = ''

    def take(self, statement, blocks, public, place):
        space = '::'.join(name for name in blocks if name)
        statement = re.sub(r'^(\[\[.*?\]\]\s*)+', '', statement)
        statement = re.sub(r'^template <.*> (?=(class|struct) [\w ]*[{:])', '', statement)
        a_class = re.match(r'(?:class|struct) (?:\[\[.*?\]\] )?(THIMBLE_EXPORT )?(\w+)(?: final)?(?: :.*| )?\{$', statement)
        if a_class:
            self.classes[f'{space}::{a_class[2]}'] = (bool(a_class[1]), public, place)
        elif re.match(r'(namespace|template|using|typedef|enum|class|struct|inline|constexpr|static|extern template)\b', statement):
            pass
        elif statement.endswith(';'):
            name = re.search(r'(\w+)\(', statement.replace('__attribute__(', '').replace('operator()', 'operator'))
            variable = re.search(r'(\w+);$', statement) if 'extern' in statement else None
            if 'operator' in statement:
                self.functions[f'{space}::operator'].append((MARK in statement, public, place))
            elif name or variable:
                self.functions[f'{space}::{(name or variable)[1]}'].append((MARK in statement, public, place))


def main():
    source, build = map(pathlib.Path, sys.argv[1:3])
    headers = Headers()
    for folders in FOLDERS.values():
        for folder in folders:
            for path in sorted((source / folder).rglob('*.h')):
                place = path.relative_to(source)
                headers.read(path, 'include' in place.parts, place)

    defined, wanted = {}, {}
    uses = [path for path in build.rglob('*.a') if '/tests/' not in str(path)]
    uses += [path for path in (build / 'app').rglob('*.o') if '/thimble.dir/' in str(path) or '/thimble_python.dir/' in str(path)]
    # Weak symbols that a library does not define come from a class with a source, or from a template instantiated in a source.
    uses = {path: symbols([path], 'U', '-u') - symbols([path], KINDS, '--defined-only') for path in uses}
    for library in FOLDERS:
        own = archive(build, library)
        defined[library] = symbols([own], KINDS, '--defined-only')
        wanted[library] = set().union(*(names for path, names in uses.items() if path != own)) & defined[library]
        defined[library] -= symbols([own], 'W', '--defined-only') - wanted[library]

    looked, missing = {}, {}  # by place; values of looked: whether it is public
    for library in FOLDERS:
        names = demangled(defined[library])
        for symbol in sorted(defined[library]):
            name, arguments = without_arguments(names[symbol])
            if not name.startswith('thimble::') or arguments and symbol not in wanted[library]:
                continue  # instantiated by its users
            # An instance of a template is hidden if one of its arguments is hidden.
            for argument in re.findall(r'thimble::[\w:]+', arguments) if symbol in wanted[library] else []:
                if argument in headers.classes and not headers.classes[argument][0]:
                    missing[headers.classes[argument][2]] = f'class {argument}: another library needs {names[symbol]}'
            # A member of a class, or of a nested class.
            above = name
            while '::' in above and above not in headers.classes:
                above = above.rpartition('::')[0]
            if above != name and above in headers.classes:
                marked, public, place = headers.classes[above]
                if public or symbol in wanted[library]:
                    looked[place] = public
                    if not marked:
                        missing[place] = f'class {above}: {"public" if public else "another library needs"} {names[symbol]}'
            elif name in headers.functions:
                of_name = headers.functions[name]
                for marked, public, place in of_name:
                    if public:
                        looked[place] = True
                        if not marked:
                            missing[place] = f'{name} is public'
                if symbol in wanted[library] and not any(marked for marked, _, _ in of_name):
                    missing[of_name[0][2]] = f'{name}: another library needs {names[symbol]}'
                if symbol in wanted[library]:
                    looked[of_name[0][2]] = of_name[0][1]
            elif symbol in wanted[library]:
                missing[name] = f'{names[symbol]}: another library needs it, but its declaration was not found'
    for place, text in sorted(missing.items()):
        print(f'{place}: no {MARK}: {text}')
    public = sum(looked.values())
    print(f'{public} public and {len(looked) - public} other classes and functions: {len(missing)} without {MARK}')
    sys.exit(bool(missing))


main()
