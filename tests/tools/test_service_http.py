"""What a page asks for by HTTP, and who may ask."""

from __future__ import annotations

import asyncio
import re
import threading

import pytest
from rkm04_tools.service.curves import Curves, Wanted
from rkm04_tools.service.trouble import Superseded
from service_client import PAGE
from websockets.exceptions import InvalidStatus

ENDLESS = "@1 S2000 V16000 A60000 F1 R D J1"


@pytest.fixture
def draw(service):
    def ask(*programs: str, **more):
        texts = {str(motor): text for motor, text in enumerate(programs, 1)}
        reply = service.call("/api/curve", {"programs": texts, **more})
        assert reply.status == 200, reply.text
        return reply.json

    return ask


def test_the_page_comes_with_a_cookie_that_scripts_cannot_read(service):
    reply = service.call("/")

    assert reply.text == PAGE
    name = f"rkm04_token_{service.port}={service.token}"
    assert reply.headers["set-cookie"] == f"{name}; HttpOnly; SameSite=Strict; Path=/"


def test_the_cookie_is_as_good_as_the_token(service):
    cookie = f"other=1; rkm04_token_{service.port}={service.token}"

    assert service.call("/", token="", Cookie=cookie).status == 200
    assert service.call("/api/examples", token="", Cookie=cookie).status == 200


@pytest.mark.parametrize("path", ["/", "/static/index.html", "/api/examples", "/nothing", "/ws"])
@pytest.mark.parametrize("token", ["", "wrong", "%00", "\N{SNOWMAN}".encode().hex()])
def test_nobody_gets_anything_without_the_token(service, path, token):
    reply = service.call(path, token=token)

    assert reply.status == 403
    assert PAGE not in reply.text
    assert "set-cookie" not in reply.headers


@pytest.mark.parametrize("cookie", ["rkm04_token_1=x", "a=b; c", "=;=", "\xff\xfe"])
def test_a_wrong_cookie_is_no_token(service, cookie):
    assert service.call("/", token="", Cookie=cookie).status == 403


@pytest.mark.parametrize(
    "origin", ["http://127.0.0.1.nip", "null", "https://127.0.0.1", "http://127.0.0.1:1", ""]
)
def test_a_page_of_another_origin_gets_nothing(service, origin):
    assert service.call("/api/check", {"text": "R"}, Origin=origin).status == 403
    assert service.call("/", Origin=origin).status == 403


def test_both_names_of_this_machine_are_good_origins(service):
    for name in ("127.0.0.1", "localhost"):
        origin = f"http://{name}:{service.port}"
        assert service.call("/api/check", {"text": "R"}, Origin=origin).status == 200


@pytest.mark.parametrize("host", ["example.com", "127.0.0.1", "127.0.0.1:1", "localhost.evil:80"])
def test_another_name_of_the_server_is_refused(service, host):
    assert service.call("/", Host=host).status == 403


@pytest.mark.parametrize(
    ("token", "origin"),
    [("wrong", None), ("", None), (None, "http://localhost:1"), (None, "null")],
)
def test_the_web_socket_is_guarded_as_well(service, token, origin):
    with pytest.raises(InvalidStatus) as refused:
        service.browser(token, origin)
    assert refused.value.response.status_code == 403


def test_the_page_may_load_nothing_from_elsewhere(service):
    policy = service.call("/").headers["content-security-policy"]

    assert "default-src 'self'" in policy
    assert set(re.findall(r"\w+://([^ ;]+)", policy)) == {
        f"127.0.0.1:{service.port}",
        f"localhost:{service.port}",
    }


def test_files_beside_the_page_stay_hidden(service):
    for path in ("/static/../host/bin/rkm04-host", "/static/%2e%2e/host", "/static/nothing.js"):
        assert service.call(path).status in (403, 404)


def test_every_example_comes_with_its_inputs(service):
    found = {each["name"]: each for each in service.call("/api/examples").json}

    assert found["4-loop.rks"]["text"].strip().startswith("{")
    assert found["4-loop.rks"]["inputs"] == []
    assert found["3-branch.rks"]["inputs"][0][1:] in ([5, 0], [5, 1])
    assert len(found) >= 14


def test_errors_have_the_place_of_the_command(service):
    told = service.call("/api/check", {"text": "F100 R\nS100 V20000 q I5X3"}).json

    places = [(p["line"], p["column"], p["end_column"], p["severity"]) for p in told["problems"]]
    assert places == [(2, 6, 12, "error"), (2, 13, 14, "error"), (2, 15, 19, "error")]
    assert "V (maximum speed)" in told["problems"][0]["message"]


def test_an_open_comment_is_wrong_to_the_end_of_its_line(service):
    (problem,) = service.call("/api/check", {"text": "R {abc\ndef"}).json["problems"]

    assert (problem["line"], problem["column"], problem["end_column"]) == (1, 3, 7)


def test_a_good_program_has_its_warnings_and_its_length(service):
    told = service.call("/api/check", {"text": "\\ F100 R J7"}).json

    assert [problem["severity"] for problem in told["problems"]] == ["warning"]
    assert told["commands"] == 3


def test_columns_count_characters(service):
    (problem,) = service.call("/api/check", {"text": "{\N{SNOWMAN}č} V0"}).json["problems"]

    assert (problem["column"], problem["end_column"]) == (6, 8)


def test_the_curve_is_that_of_the_move(draw):
    told = draw("\\ S100 V1000 A2000 F1000 R")
    motor = told["motors"]["1"]

    assert told["ended"]
    assert told["error"] is None
    assert motor["pulses"] == 1000
    assert motor["peak"] == pytest.approx(1000, abs=1)
    assert max(motor["speed"]) == pytest.approx(1000, abs=1)
    assert (motor["position"][0], motor["position"][-1]) == (0, 1000)
    assert motor["t"] == sorted(motor["t"])
    assert len(motor["t"]) == len(motor["speed"]) == len(motor["position"])
    assert motor["t"][-1] == pytest.approx(told["seconds"], abs=1e-5)


def test_four_motors_have_a_curve_each(draw):
    told = draw("F1 R", "F2 R", "B3 R", "G7")

    ends = {motor: curve["position"][-1] for motor, curve in told["motors"].items()}
    assert ends == {"1": 1, "2": 2, "3": -3, "4": 7}


def test_the_curve_tells_when_each_command_began(draw):
    motor = draw("\\ C100 S100\nW500 F10\nR W20")["motors"]["1"]

    assert [place for _, place in motor["commands"]] == [1, 2, 3, 4, 5, 6]
    begun = [at for at, _ in motor["commands"]]
    assert begun[:3] == [0, 0, 0]
    assert begun[3:5] == [pytest.approx(0.5, abs=0.001)] * 2
    assert begun == sorted(begun)
    assert (motor["command"], motor["commands_cut"]) == (0, None)


def test_a_part_of_the_curve_begins_at_the_command_that_was_run_then(draw):
    motor = draw("\\ C100 W500\nW500 F10 R", range=[0.2, 0.7])["motors"]["1"]

    assert motor["command"] == 2
    assert [place for _, place in motor["commands"]] == [3]


def test_what_a_loop_runs_is_told_as_far_as_there_is_room(draw):
    motor = draw("@1 W1 J1", seconds=5, points=30)["motors"]["1"]

    assert len(motor["commands"]) == 30
    assert motor["commands"][-1][0] <= motor["commands_cut"] < 0.1


def test_places_of_a_program_of_several_messages_are_those_in_its_text(draw):
    motor = draw("=-2000000000\n" * 690 + "W500 F10 R", points=2000)["motors"]["1"]

    assert motor["commands"][0] == [0, 0]
    assert [place for _, place in motor["commands"]][-4:] == [691, 692, 693, 693]


def test_inputs_and_outputs_are_part_of_the_curve(draw):
    told = draw("O03 T02 F10 R", inputs=[[500, 3, 1]])

    assert told["outputs"] == [[pytest.approx(0.5, abs=0.001), 2, 1]]
    assert told["ended"]


def test_a_program_that_waits_for_an_input_ends_with_the_time(draw):
    told = draw("\\ O03 F10 R", seconds=5)

    assert (told["seconds"], told["ended"], told["cut"]) == (5.0, False, False)
    assert told["motors"]["1"]["state"] == "wait_level"
    assert told["motors"]["1"]["place"] == {"line": 1, "column": 3}


@pytest.mark.parametrize("text", [ENDLESS, "@1 J1", "@1 T1 C1 J1", "G+", "@1 =5 F1 R J1"])
def test_an_endless_program_has_a_curve_of_limited_size(draw, text):
    told = draw(text, text, text, text, seconds=100_000, points=600)

    assert not told["ended"]
    assert set(told["motors"]) == {"1", "2", "3", "4"}
    assert all(len(motor["t"]) <= 602 for motor in told["motors"].values())
    assert len(told["outputs"]) <= 600


def test_a_program_of_700_commands_has_a_curve(draw):
    motor = draw("\\ S1000 V8000 A40000 " + "F400 R W10 " * 232)["motors"]["1"]

    assert motor["moves"] == 232
    assert motor["pulses"] == 232 * 400
    assert not motor["overflow"]


def test_too_many_commands_are_told(draw):
    assert draw("W1 " * 701)["motors"]["1"]["overflow"]


def test_an_error_while_it_runs_is_told_with_its_place(draw):
    motor = draw("\\ F10 R\nJ7")["motors"]["1"]

    assert motor["state"] == "failed"
    assert motor["error"]
    assert motor["place"] == {"line": 2, "column": 1}


def test_a_program_with_errors_has_no_curve(draw):
    told = draw("F1 R", "F1 Q")

    assert told["motors"] == {}
    assert told["error"] == 'motor 2, line 1, column 4: unknown command "Q"'


def test_a_part_of_the_time_comes_in_full_detail(draw):
    text = "\\ S2000 V16000 A60000 F900000 R"
    part = draw(text, range=[0.10, 0.15], points=6000)["motors"]["1"]

    steps = [new - old for old, new in zip(part["position"], part["position"][1:], strict=False)]
    assert len(steps) > 400
    assert set(steps) == {1}
    assert part["t"][0] < 0.10 <= part["t"][1]
    assert part["t"][-2] <= 0.15 < part["t"][-1]


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("/api/check", b""),
        ("/api/check", b"{"),
        ("/api/check", b"[" * 100_000),
        ("/api/check", b"\xff\xfe"),
        ("/api/check", []),
        ("/api/check", {}),
        ("/api/check", {"text": 5}),
        ("/api/curve", {}),
        ("/api/curve", {"programs": {}}),
        ("/api/curve", {"programs": ["R"]}),
        ("/api/curve", {"programs": {"5": "R"}}),
        ("/api/curve", {"programs": {"1": None}}),
        ("/api/curve", {"programs": {"1": "R"}, "seconds": 0}),
        ("/api/curve", {"programs": {"1": "R"}, "seconds": "60"}),
        ("/api/curve", {"programs": {"1": "R"}, "seconds": True}),
        ("/api/curve", b'{"programs": {"1": "R"}, "seconds": NaN}'),
        ("/api/curve", b'{"programs": {"1": "R"}, "seconds": 1e999}'),
        ("/api/curve", b'{"programs": {"1": "R"}, "seconds": 1' + b"0" * 400 + b"}"),
        ("/api/curve", b'{"programs": {"1": "R"}, "seconds": 1' + b"0" * 5000 + b"}"),
        ("/api/curve", {"programs": {"1": "R"}, "points": 1}),
        ("/api/curve", {"programs": {"1": "R"}, "points": 10_000_000}),
        ("/api/curve", {"programs": {"1": "R"}, "inputs": {}}),
        ("/api/curve", {"programs": {"1": "R"}, "inputs": [[1, 2]]}),
        ("/api/curve", {"programs": {"1": "R"}, "inputs": [[1, 9, 1]]}),
        ("/api/curve", {"programs": {"1": "R"}, "inputs": [[-1, 1, 1]]}),
        ("/api/curve", {"programs": {"1": "R"}, "inputs": [[1, 1.5, 1]]}),
        ("/api/curve", {"programs": {"1": "R"}, "inputs": [[1, 1, 2]]}),
        ("/api/curve", {"programs": {"1": "R"}, "inputs": [[1, 1, 1]] * 10_001}),
        ("/api/curve", {"programs": {"1": "R"}, "range": [3, 2]}),
        ("/api/curve", {"programs": {"1": "R"}, "range": 3}),
        ("/api/curve", {"programs": {"1": "R"}, "page": 3}),
    ],
)
def test_what_cannot_be_meant_is_refused_in_words(service, path, body):
    reply = service.call(path, body)

    assert reply.status == 400
    error = reply.json["error"]
    assert error["kind"] == "BadRequest"
    assert error["cause"]
    assert error["next"]


@pytest.mark.parametrize(
    "body",
    [b'{"text": "' + b"R" * 5_000_001 + b'"}', {"text": "R" * 1_000_001}],
    ids=["bytes", "characters"],
)
def test_more_than_any_program_is_refused(service, body):
    assert service.call("/api/check", body).status == 413


@pytest.mark.parametrize("text", ["", " ", "\0", "\ud800", "\N{SNOWMAN}" * 1000, "(" * 10_000])
def test_any_text_can_be_checked_and_drawn(service, draw, text):
    assert service.call("/api/check", {"text": text}).status == 200
    assert draw(text, seconds=1)["seconds"] >= 0


@pytest.mark.parametrize(
    ("path", "body"), [("/api/check", None), ("/api/curve", None), ("/api/examples", {"a": 1})]
)
def test_the_wrong_method_is_refused(service, path, body):
    assert service.call(path, body).status == 405


def test_a_newer_curve_of_the_same_page_ends_the_older_one():
    async def both():
        curves = Curves()
        older = asyncio.create_task(curves.make(Wanted({1: "@1 J1"}, [], 100_000, page="one")))
        await asyncio.sleep(0)  # it has begun
        newer = await curves.make(Wanted({1: "F1 R"}, [], page="one"))
        return await asyncio.gather(older, return_exceptions=True), newer

    (older,), newer = asyncio.run(both())

    assert isinstance(older, Superseded)
    assert newer["motors"]["1"]["pulses"] == 1


def test_a_curve_that_nobody_waits_for_any_more_is_given_up():
    async def given_up():
        task = asyncio.create_task(Curves().make(Wanted({1: "@1 J1"}, [], 100_000, page="one")))
        await asyncio.sleep(0.05)
        task.cancel()
        return await asyncio.gather(task, return_exceptions=True)

    (ended,) = asyncio.run(given_up())

    assert isinstance(ended, asyncio.CancelledError)


def test_curves_of_two_pages_do_not_disturb_each_other(service):
    slow = {"programs": {"1": "@1 J1"}, "seconds": 100_000, "page": "one"}
    replies = []
    other = threading.Thread(target=lambda: replies.append(service.call("/api/curve", slow)))
    other.start()
    assert service.call("/api/curve", {"programs": {"1": "F1 R"}, "page": "two"}).status == 200
    other.join()

    assert replies[0].status == 200
    assert replies[0].json["cut"]
