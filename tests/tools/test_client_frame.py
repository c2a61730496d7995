"""The frames that tools make and read agree with the shared vectors, whatever comes."""

from __future__ import annotations

import json
from pathlib import Path

import frames
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rkm04_tools.frame import MESSAGE_BYTES_MAX, Frame, Receiver

VECTORS = json.loads((Path(__file__).resolve().parents[1] / "vectors" / "frames.json").read_text())


def named(key: str) -> list[object]:
    return [pytest.param(vector, id=vector["name"]) for vector in VECTORS[key]]


def received(data: bytes) -> list[Frame]:
    return list(Receiver().feed(data))


@pytest.mark.parametrize("vector", named("frames"))
def test_a_message_is_enclosed_as_in_the_vectors(vector):
    frame = Frame(vector["address"], vector["number"], bytes.fromhex(vector["message"]))

    assert frame.encode().hex() == vector["frame"]


@pytest.mark.parametrize("vector", named("frames"))
def test_a_frame_of_the_vectors_is_received(vector):
    frame = Frame(vector["address"], vector["number"], bytes.fromhex(vector["message"]))

    assert received(bytes.fromhex(vector["frame"])) == [frame]


@pytest.mark.parametrize("vector", named("dropped"))
def test_a_bad_frame_of_the_vectors_is_dropped_and_told(vector):
    receiver = Receiver()

    assert list(receiver.feed(bytes.fromhex(vector["bytes"]))) == []
    assert receiver.is_damaged


def test_all_vectors_in_a_row_give_the_good_ones():
    bad = [each["bytes"] for each in VECTORS["dropped"] if each["count"] != "STRAY"]
    good = VECTORS["frames"][: len(bad)]
    pairs = zip(bad, good, strict=True)
    stream = "".join(dropped + frame["frame"] for dropped, frame in pairs)

    messages = [frame.message.hex() for frame in received(bytes.fromhex(stream))]

    assert messages == [frame["message"] for frame in good]


@pytest.mark.parametrize(("extra", "count"), [(0, 1), (1, 0)])
def test_the_longest_answer_is_received_and_a_longer_one_is_not(extra, count):
    receiver = Receiver()
    frame = Frame(0x81, 1, bytes(MESSAGE_BYTES_MAX + extra))

    assert len(list(receiver.feed(frame.encode()))) == count
    assert receiver.is_damaged == (count == 0)


ANY_FRAME = st.builds(
    Frame, st.integers(0, 255), st.integers(0, 255), st.binary(min_size=1, max_size=300)
)


@given(frame=ANY_FRAME, cut=st.integers(0, 700))
def test_a_frame_makes_the_way_there_and_back_in_any_pieces(frame, cut):
    receiver = Receiver()
    data = frame.encode()

    assert [*receiver.feed(data[:cut]), *receiver.feed(data[cut:])] == [frame]
    assert not receiver.is_damaged


@given(frame=ANY_FRAME)
def test_both_implementations_make_the_same_bytes(frame):
    assert frame.encode() == frames.frame(frame.address, frame.number, frame.message)


@given(noise=st.binary(max_size=400), frame=ANY_FRAME)
def test_after_any_noise_the_second_frame_at_the_latest_is_received(noise, frame):
    assert frame in received(noise + frame.encode() + frame.encode())


@given(frame=ANY_FRAME, data=st.data())
def test_a_wrong_bit_between_the_flags_is_noticed(frame, data):
    content = bytearray(frame.encode())
    bit = data.draw(st.integers(8, 8 * len(content) - 9))
    content[bit // 8] ^= 1 << bit % 8

    assert frame not in received(bytes(content))
