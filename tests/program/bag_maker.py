"""Makes a ROS 2 bag (SQLite) with only Python's sqlite3 and struct, or prints the contents of one.
   bag_maker.py make FILE.db3 [KIND]     KIND: circle (default), nan, back
   bag_maker.py show FOLDER              a line per topic: name, type, number of messages, first three numbers of the last one
"""
import glob
import math
import sqlite3
import struct
import sys


def message(time_ns, vector, rest):
    frame = b"world\0"
    body = struct.pack("<iII", time_ns // 10**9, time_ns % 10**9, len(frame)) + frame
    body += b"\0" * (-len(body) % 8)
    return b"\0\1\0\0" + body + struct.pack("<%dd" % (3 + len(rest)), *vector, *rest)


def make(name, kind):
    bag = sqlite3.connect(name)
    bag.executescript("""
        CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                            serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
        CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
                              timestamp INTEGER NOT NULL, data BLOB NOT NULL);
        CREATE INDEX timestamp_idx ON messages (timestamp ASC);""")
    bag.execute("INSERT INTO topics VALUES (1, '/arm/pose', 'geometry_msgs/msg/PoseStamped', 'cdr', '')")
    start = 1_700_000_000 * 10**9
    for i in range(201):
        time = 0.01 * i
        x = math.nan if kind == "nan" and i == 7 else 0.01 * math.sin(math.pi * time)
        stamp = start + 10**7 * (3 if kind == "back" and i == 7 else i)
        data = message(stamp, (x, 0.005, 0.02 - 0.01 * time), (0, 0, 0, 1))
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (1, ?, ?)", (start + 10**7 * i + 5, data))
    bag.commit()


def show(folder):
    bag = sqlite3.connect(glob.glob(folder + "/*.db3")[0])
    for number, name, kind in bag.execute("SELECT id, name, type FROM topics ORDER BY id").fetchall():
        rows = bag.execute("SELECT data FROM messages WHERE topic_id = ? ORDER BY timestamp", (number,)).fetchall()
        print(name, kind, len(rows), *struct.unpack_from("<3d", rows[-1][0], 4 + 24))


if sys.argv[1] == "make":
    make(sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else "circle")
else:
    show(sys.argv[2])
