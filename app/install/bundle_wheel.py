#!/usr/bin/env python3
"""Makes a wheel that needs neither a compiler nor Debian's libraries: copies the shared libraries into it.

    python3 bundle_wheel.py thimble-0.3.0-cp311-cp311-linux_x86_64.whl [FOLDER]

Works as auditwheel does, which Debian 12 does not have: each library that is not part of every desktop Linux is copied
into the folder thimble.libs under a unique name, every program and library of the wheel finds it there by a relative
path, and the tag of the wheel names the oldest C library with which it runs (manylinux_2_36 if built on Debian 12, PEP
600). Licences of the copied libraries are included. Needs Debian's patchelf and binutils.
"""

import base64
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

# Libraries that stay outside: the C and C++ libraries, whose versions the tag states, and those that belong to the
# system's graphics and sound. [chosen: libraries that PEP 600 allows outside, and those that must fit the drivers]
OUTSIDE = re.compile(
    r"ld-linux.*|lib(c|m|dl|rt|pthread|resolv|util|nsl|anl|mvec|stdc\+\+|gcc_s)\.so\..*"
    r"|lib(GL|EGL|GLX|OpenGL|GLdispatch|X11|Xext|Xrender|ICE|SM|xcb|wayland-client|asound|pulse|pulse-simple)\.so\..*"
)


class BundleError(Exception):
    """The wheel cannot be made; the message has the remedy."""


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def elf_files(folder):
    """Returns the programs and shared libraries below a folder."""
    return [one for one in sorted(folder.rglob("*")) if one.is_file() and not one.is_symlink() and one.open("rb").read(4) == b"\x7fELF"]


def needed(file):
    return output_of("patchelf", "--print-needed", str(file)).split()


def found_libraries(file):
    """Returns the path of each library that the loader finds for a file, by its name."""
    done = subprocess.run(["ldd", str(file)], capture_output=True, text=True)
    missing = re.findall(r"^\s*(\S+) => not found", done.stdout, re.MULTILINE)
    if missing:
        raise BundleError(f"{file.name} needs {', '.join(missing)}, which is not installed. Install it, and run this again.")
    return dict(re.findall(r"^\s*(\S+) => (\S+)", done.stdout, re.MULTILINE))


def dependencies(files):
    """Returns the libraries to copy: path by name."""
    copied = {}
    waiting = list(files)
    while waiting:
        file = waiting.pop()
        found = found_libraries(file)
        for name in needed(file):
            if OUTSIDE.fullmatch(name) or name in copied or name not in found:
                continue
            copied[name] = Path(found[name]).resolve()
            waiting.append(copied[name])
    return copied


def own_name(name, file):
    """Returns a name that no other wheel uses: libz.so.1 becomes libz-0123abcd.so.1."""
    stem, _, version = name.partition(".so")
    return f"{stem}-{hashlib.sha256(file.read_bytes()).hexdigest()[:8]}.so{version}"


def bundle(root, package):
    """Copies libraries into root/PACKAGE.libs, and makes all files of the wheel use them. Returns them by name."""
    files = elf_files(root)
    if not files:
        raise BundleError("The wheel has no programs or libraries; it is not one of `pip wheel .`.")
    libraries = dependencies(files)
    place = root / f"{package}.libs"
    place.mkdir(exist_ok=True)
    names = {name: own_name(name, file) for name, file in libraries.items()}
    for name, file in libraries.items():
        shutil.copy(file, place / names[name])
        os.chmod(place / names[name], 0o755)
    for file in [*files, *(place / one for one in names.values())]:
        changes = [["--replace-needed", name, names[name]] for name in needed(file) if name in names]
        if file.parent == place:
            changes.append(["--set-soname", file.name])
        if changes:
            to_libraries = os.path.relpath(place, file.parent)
            path = "$ORIGIN" if to_libraries == "." else f"$ORIGIN/{to_libraries}"
            changes.append(["--force-rpath", "--set-rpath", path])
        for change in changes:  # one for each call: patchelf 0.14 confuses the names of several
            subprocess.run(["patchelf", *change, str(file)], check=True)
    return libraries


def glibc(files):
    """Returns the newest version of the C library that any of the files needs, as (2, 36)."""
    newest = (2, 17)
    for file in files:
        for version in re.findall(r"\bGLIBC_(\d+)\.(\d+)", output_of("objdump", "-T", str(file))):
            newest = max(newest, (int(version[0]), int(version[1])))
    return newest


def add_licences(root, libraries):
    """Copies the copyright files of the Debian packages of all libraries. Returns libraries without one."""
    (metadata,) = root.glob("*.dist-info")
    without = []
    for name, file in libraries.items():
        owner = subprocess.run(["dpkg", "-S", str(file)], capture_output=True, text=True).stdout.partition(":")[0]
        if not owner:  # the merged /usr: the package has the file in /lib
            owner = subprocess.run(["dpkg", "-S", str(file).removeprefix("/usr")], capture_output=True, text=True).stdout.partition(":")[0]
        copyright = Path("/usr/share/doc", owner, "copyright") if owner else None
        if copyright is None or not copyright.is_file():
            without.append(name)
            continue
        (metadata / "licenses").mkdir(exist_ok=True)
        shutil.copy(copyright, metadata / "licenses" / f"{owner}.txt")
    return without


def retag(root, platform):
    """Writes the platform into the file WHEEL. Returns the tag, such as cp311-cp311-manylinux_2_36_x86_64."""
    (wheel,) = root.glob("*.dist-info/WHEEL")
    text = re.sub(r"^(Tag: [^-\n]+-[^-\n]+-)\S+$", rf"\g<1>{platform}", wheel.read_text(), flags=re.MULTILINE)
    wheel.write_text(text)
    return re.search(r"^Tag: (\S+)", text, re.MULTILINE)[1]


def pack(root, wheel):
    """Writes all files and their RECORD into a wheel."""
    (metadata,) = root.glob("*.dist-info")
    record = metadata / "RECORD"
    files = [one for one in sorted(root.rglob("*")) if one.is_file() and one != record]
    lines = []
    for file in files:
        digest = base64.urlsafe_b64encode(hashlib.sha256(file.read_bytes()).digest()).rstrip(b"=").decode()
        lines.append(f"{file.relative_to(root).as_posix()},sha256={digest},{file.stat().st_size}")
    lines.append(f"{record.relative_to(root).as_posix()},,")
    record.write_text("\n".join(lines) + "\n")
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in [*files, record]:
            entry = zipfile.ZipInfo(file.relative_to(root).as_posix(), (2020, 1, 1, 0, 0, 0))
            entry.external_attr = (0o100000 | (file.stat().st_mode & 0o777)) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, file.read_bytes())


def unpack(wheel, root):
    with zipfile.ZipFile(wheel) as archive:
        for entry in archive.infolist():
            path = Path(archive.extract(entry, root))
            mode = entry.external_attr >> 16 & 0o777
            if mode and path.is_file():
                path.chmod(mode)


def main(arguments):
    if len(arguments) not in (1, 2):
        raise BundleError("usage: bundle_wheel.py WHEEL [FOLDER]")
    for program in ("patchelf", "objdump", "ldd"):
        if shutil.which(program) is None:
            raise BundleError(f"{program} is missing. Install patchelf and binutils.")
    wheel, folder = Path(arguments[0]), Path(arguments[1] if len(arguments) > 1 else ".")
    if not zipfile.is_zipfile(wheel):
        raise BundleError(f"{wheel} is no wheel. Make one with `pip wheel --no-deps .`.")
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as temporary:
        root = Path(temporary)
        unpack(wheel, root)
        package = wheel.name.partition("-")[0]
        libraries = bundle(root, package)
        newest = glibc(elf_files(root))
        without = add_licences(root, libraries)
        tag = retag(root, f"manylinux_{newest[0]}_{newest[1]}_{os.uname().machine}")
        name = "-".join([*wheel.name.split("-")[:2], tag]) + ".whl"
        pack(root, folder / name)
    print(f"{folder / name}: {len(libraries)} libraries, {(folder / name).stat().st_size / 1e6:.1f} MB")
    if without:
        print(f"No licence text was found for {', '.join(sorted(without))}; add it before you publish the wheel.", file=sys.stderr)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except BundleError as wrong:
        sys.exit(f"bundle_wheel.py: {wrong}")
    except subprocess.CalledProcessError as wrong:
        sys.exit(f"bundle_wheel.py: {wrong.cmd[0]} failed: {(wrong.stderr or '').strip()}")
