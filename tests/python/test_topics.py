"""ROS 2 topics of runs from Python."""
import re

import pytest
import thimble

# No message leaves this machine.
ALONE = (
    '<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo" multicast="true"/>'
    "</Interfaces></General></Domain></CycloneDDS>"
)


def test_run_is_published_and_reported(monkeypatch):
    monkeypatch.setenv("CYCLONEDDS_URI", ALONE)
    try:
        live = thimble.open("box", "sim", seconds=1, ros2={"namespace": "/python", "domain": 71, "force": "add"})
    except thimble.Error as trouble:
        if "thimble-ros2" in str(trouble) or "cannot be opened" in str(trouble):
            pytest.skip(str(trouble))
        raise
    with live:
        assert live.tick is None or live.running
    assert re.search("ticks? published; 0 forces received", live.topics)


def test_no_topics_unless_asked():
    with thimble.open("box", "sim", seconds=0.1) as live:
        pass
    assert live.topics == ""


def test_unknown_options_of_topics_are_refused():
    for ros2, word in [({"name": "x"}, "namespace"), ({"names": "omnis"}, "omni"), ({"domain": 300}, "232")]:
        with pytest.raises(thimble.Error, match=word):
            thimble.open("box", "sim", seconds=0.1, ros2=ros2)
