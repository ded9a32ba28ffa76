#!/usr/bin/env python3
"""Checks the lists of app/reading.md that follow a sample from bytes to force and a scene from YAML to objects.

Each numbered line names a file and, after a colon, what runs in it. A line is refused if the file does not exist,
if the first name beside it is not in the file or its own header, or if no earlier file reaches it: by a call of
one of the names, or by including its header, directly or through one header. The sentence below a list states how
many files it has. Last, lists with one fault each are checked, and each fault must be found.
  reading_lists.py SOURCE_DIR
"""
import functools
import os
import re
import sys

PAGE = 'app/reading.md'
SECTIONS = ['One sample, from bytes to force', 'One scene, from YAML to objects']
INCLUDE_FOLDERS = [f'{module}/{part}' for module in ('app/session', 'app/scene', 'render', 'driver')
                   for part in ('include', 'src')]
LINE = re.compile(r'(\d+)\. `([^`]+)`: (.*)')
NAME = re.compile(r'`((?:\w+::)*(?:\w+|operator\(\)))`')


@functools.lru_cache(None)
def text_of(path):
    with open(path, encoding='utf-8') as file:
        return file.read()


@functools.lru_cache(None)
def header_of(path):
    """Returns the header of a source, the file itself if it is one, None if it has none."""
    if path.endswith('.h'):
        return path
    if os.path.exists(path[:-4] + '.h'):
        return path[:-4] + '.h'
    name = os.path.basename(path)[:-4] + '.h'
    for folder, _, files in os.walk(path[:path.index('/src/')] + '/include'):
        if name in files:
            return os.path.join(folder, name)
    return None


@functools.lru_cache(None)
def included_by(path):
    """Returns the headers of this tree that a file and its own header include."""
    found = set()
    for source in filter(None, (path, header_of(path))):
        for include in re.findall(r'^#include "([^"]+)"', text_of(source), re.M):
            found |= {f'{folder}/{include}' for folder in INCLUDE_FOLDERS if os.path.exists(f'{folder}/{include}')}
    return found


def reaches(earlier, path, names):
    last = {name.split('::')[-1] for name in names} - {'operator()'}
    if any(re.search(rf'\b{name}(<[^;]*>)?\(', text_of(earlier)) for name in last):
        return True
    header = header_of(path)
    near = included_by(earlier)
    return header in near or any(header in included_by(between) for between in near)


def has(path, name):
    text = text_of(path) + (text_of(header_of(path)) if header_of(path) else '')
    return all(part in text if part == 'operator()' else re.search(rf'\b{part}\b', text) for part in name.split('::'))


def faults_of(page):
    """Returns the faults of the lists of a page, one sentence each, and the number of files in each list."""
    faults, counts = [], []
    for title in SECTIONS:
        section = page.partition(f'\n## {title}\n')[2].partition('\n## ')[0]
        count, earlier = 0, []
        for line in section.splitlines():
            if not re.match(r'\d', line):
                # Files that the page names between the lines also belong to the list.
                earlier += [path for path in re.findall(r'`([\w/]+\.(?:h|cpp))`', line) if os.path.exists(path)]
                continue
            count += 1
            match = LINE.match(line)
            if not match or int(match[1]) != count:
                faults.append(f'{title}: expected "{count}. `FILE`: `NAME`", found "{line}"')
                continue
            path, names = match[2], NAME.findall(match[3])
            if not os.path.exists(path):
                faults.append(f'{title}, {count}: there is no file {path}')
                continue
            if not names or not has(path, names[0]):
                faults.append(f'{title}, {count}: {path} does not have {names[0] if names else "a name"}')
            own = [name for name in names if has(path, name)]  # a line may also name the next step
            if count > 1 and not any(reaches(before, path, own) for before in earlier):
                faults.append(f'{title}, {count}: no earlier file reaches {path}')
            earlier.append(path)
        stated = re.search(r'These are (\d+) files:', section)
        if not stated or int(stated[1]) != count:
            faults.append(f'{title}: {count} files are listed; state this number below the list')
        counts.append(count)
    return faults, counts


def main():
    os.chdir(sys.argv[1])
    page = text_of(PAGE)
    faults, counts = faults_of(page)
    for fault in faults:
        print(f'{PAGE}: {fault}')
    for title, count in zip(SECTIONS, counts):
        print(f'{title}: {count} files')
    planted = {
        'a file that is not there': ('driver/src/wire_link.cpp', 'driver/src/wire_lynk.cpp'),
        'a function that is not in its file': ('`SurfaceTracker::follow`', '`SurfaceTracker::pursue`'),
        'a class that is not in its file': ('`RunLoop::tick`', '`RanLoop::tick`'),
        'a file that is not reached': ('`app/scene/src/arm/arm_device_settings.cpp`: `device_settings`',
                                       '`app/session/src/hold_key.cpp`: `HoldKey`'),
        'a wrong number of files': ('These are ', 'These are 1'),
        'a line without a name': ('`judge_size`\n', '`judge_size`\n16. something\n'),
    }
    for what, (before, after) in planted.items():
        if page.count(before) == 0 or not set(faults_of(page.replace(before, after))[0]) - set(faults):
            print(f'This test does not detect {what}.')
            faults.append(what)
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
