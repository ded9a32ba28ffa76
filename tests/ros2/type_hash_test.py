"""The hashes of types that ROS 2 compares, computed again from ros_messages.idl by the rules of REP 2016
(a type's description as JSON, its SHA-256), against the table in the source.

    type_hash_test.py ros_messages.idl type_hashes.cpp
"""
import hashlib
import json
import re
import sys

# Numbers of rosidl's field types [S ros2/rosidl, type_description_interfaces FieldType.msg]; an
# unbounded sequence adds 144. An IDL octet is a byte in DiagnosticStatus and a uint8 in data.
NUMBERS = {"long": 6, "unsigned long": 7, "unsigned long long": 9, "float": 10, "double": 11, "boolean": 15, "octet": 16,
           "string": 17}
NESTED, UINT8, SEQUENCE = 1, 3, 144


def read(idl):
    """Return the fields of each type, by its name in ROS, in order."""
    types = {}
    text = re.sub(r"//.*", "", idl)
    for package, body in re.findall(r"module (\w+) \{ module msg \{ module dds_ \{(.*?)\}; \}; \};", text, re.S):
        for name, inside in re.findall(r"struct (\w+)_ \{(.*?)\}", body, re.S):
            fields = []
            for field in filter(None, (one.strip() for one in inside.split(";"))):
                kind, field_name = field.rsplit(None, 1)
                fields.append((field_name, kind.strip()))
            types[f"{package}/msg/{name}"] = fields
    return types


def described(types, name):
    fields = []
    for field, kind in types[name]:
        offset = 0
        if kind.startswith("sequence<"):
            offset, kind = SEQUENCE, kind[len("sequence<"):-1]
        nested = ""
        if kind == "octet" and offset:
            number = UINT8
        elif kind in NUMBERS:
            number = NUMBERS[kind]
        else:
            number, nested = NESTED, full_name(types, name, kind)
        fields.append({"name": field, "type": {"type_id": number + offset, "capacity": 0, "string_capacity": 0,
                                               "nested_type_name": nested}})
    return {"type_name": name, "fields": fields}


def full_name(types, inside, kind):
    if "::" in kind:
        package, _, _, short = kind.split("::")
        return f"{package}/msg/{short[:-1]}"
    return f"{inside.split('/')[0]}/msg/{kind[:-1]}"


def named_in(types, name, found):
    for field in described(types, name)["fields"]:
        nested = field["type"]["nested_type_name"]
        if nested and nested not in found:
            found.add(nested)
            named_in(types, nested, found)
    return found


def hash_of(types, name):
    whole = {"type_description": described(types, name),
             "referenced_type_descriptions": [described(types, one) for one in sorted(named_in(types, name, set()))]}
    return "RIHS01_" + hashlib.sha256(json.dumps(whole).encode()).hexdigest()


def main():
    idl, source = (open(path, encoding="utf-8").read() for path in sys.argv[1:3])
    types = read(idl)
    table = dict(re.findall(r'\{"([\w:]+)",\s*"(RIHS01_[0-9a-f]+)"\}', source))
    topics = re.findall(r"@topic struct (\w+)_", idl)
    wrong = 0
    if len(table) != len(topics):
        print(f"{len(topics)} types are topics, {len(table)} have a hash")
        wrong += 1
    for dds_name, listed in table.items():
        package, _, _, short = dds_name.split("::")
        computed = hash_of(types, f"{package}/msg/{short[:-1]}")
        if computed != listed:
            print(f"{dds_name}: the table has {listed}, the IDL gives {computed}")
            wrong += 1
    # Hashes that ROS 2 Kilted generates for these [S hpmicro/hpm_sdk, middleware/microros/kilted].
    published = {
        "geometry_msgs/msg/PoseStamped": "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8",
        "sensor_msgs/msg/JointState": "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e",
        "visualization_msgs/msg/MarkerArray": "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf",
    }
    for name, listed in published.items():
        if hash_of(types, name) != listed:
            print(f"{name}: {hash_of(types, name)} is not what ROS 2 has")
            wrong += 1
    print(f"{len(table)} hashes, {wrong} wrong")
    return wrong != 0


sys.exit(main())
