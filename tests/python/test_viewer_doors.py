"""Access to the page of a viewer, and checks of its messages."""

import http.client
from collections.abc import Iterator
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest

import beetle_ik as bik

viser = pytest.importorskip("viser", reason="the viewer needs the extra 'view'")
msgspec = pytest.importorskip("msgspec")

from viewer_turns import until  # noqa: E402
from websockets.exceptions import ConnectionClosed, InvalidStatus  # noqa: E402
from websockets.sync.client import ClientConnection, connect  # noqa: E402

from beetle_ik.viewing.admission import Admission  # noqa: E402

ROBOT = bik.Robot.planar([0.5, 0.4, 0.3]).with_capsules(radius=0.02)
GOOD = {"type": "TransformControlsUpdateMessage", "name": "/target", "wxyz": (1, 0, 0, 0), "owner": ""}


def encoded(**fields: Any) -> bytes:
    return msgspec.msgpack.encode(fields)


CAMERA = encoded(
    type="ViewerCameraMessage",
    wxyz=(1, 0, 0, 0),
    position=(1, 1, 1),
    fov=0.8,
    near=0.1,
    far=100,
    image_height=480,
    image_width=640,
    look_at=(0, 0, 0),
    up_direction=(0, 0, 1),
)


@pytest.fixture(scope="module")
def viewer() -> Iterator[bik.Viewer]:
    with bik.view(ROBOT, port=0) as viewer:
        yield viewer


@pytest.fixture(scope="module")
def shared() -> Iterator[bik.Viewer]:
    with bik.view(ROBOT, port=0, host="0.0.0.0") as viewer:
        yield viewer


def place(viewer: bik.Viewer) -> str:
    return f"127.0.0.1:{urlsplit(viewer.url).port}"


def token(viewer: bik.Viewer) -> str:
    return viewer.url.partition("?token=")[2]


def page(viewer: bik.Viewer, path: str = "/", **headers: str) -> tuple[int, dict[str, str], bytes]:
    connection = http.client.HTTPConnection(place(viewer))
    connection.putrequest("GET", path, skip_host=True)
    for name, value in ({"Host": place(viewer)} | headers).items():
        connection.putheader(name, value)
    connection.endheaders()
    response = connection.getresponse()
    content = response.read()
    connection.close()
    return response.status, dict(response.getheaders()), content


def joined(viewer: bik.Viewer, **headers: str) -> ClientConnection:
    return connect(
        f"ws://{place(viewer)}/",
        subprotocols=[f"viser-v{viser.__version__}"],
        additional_headers=headers,
        max_size=None,
    )


def websocket_status(viewer: bik.Viewer, **headers: str) -> int:
    try:
        with joined(viewer, **headers):
            return 101
    except InvalidStatus as refused:
        return refused.response.status_code


def dragged(x: float, **changes: Any) -> bytes:
    return encoded(**{**GOOD, "position": (x, 0.3, 0.0), **changes})


def arrives(viewer: bik.Viewer, x: float) -> None:
    until(lambda: viewer.target[0, 3] == x)


# --- who may use it ---


def test_other_names_of_this_machine_get_no_page(viewer: bik.Viewer) -> None:
    port = urlsplit(viewer.url).port
    for host in ("127.0.0.1", "localhost", "LOCALHOST", "[::1]"):
        assert page(viewer, Host=f"{host}:{port}")[0] == 200
        assert websocket_status(viewer, Host=f"{host}:{port}") in (101, 400)  # a second Host is not HTTP
    for host in ("evil.example", "127.0.0.1.evil.example", "10.0.0.1", "", "[", "localhost@evil.example"):
        status, _, content = page(viewer, Host=f"{host}:{port}")
        assert (status, content) == (421, b"this viewer is not at this address\n")


ORIGINS = (
    "http://evil.example",
    "null",
    "http://127.0.0.1",
    "http://127.0.0.1:1",
    "file://",
    "http://localhost:80",
    "",
)


@pytest.mark.parametrize("origin", ORIGINS)
def test_pages_of_other_origins_are_refused(viewer: bik.Viewer, origin: str) -> None:
    assert websocket_status(viewer, Origin=origin) == 403
    status, _, content = page(viewer, Origin=origin)
    assert (status, content) == (403, b"this viewer takes no requests of other pages\n")


def test_the_page_itself_and_programs_without_origin_connect(viewer: bik.Viewer) -> None:
    assert websocket_status(viewer) == 101
    assert websocket_status(viewer, Origin=f"http://{place(viewer)}") == 101


def test_a_forwarded_port_has_the_same_origin() -> None:
    admission = Admission("127.0.0.1")
    forwarded = {"Host": "localhost:9000", "Origin": "http://localhost:9000"}
    assert admission.refusal("/", forwarded) is None
    assert admission.refusal("/", {**forwarded, "Origin": "http://localhost:9001"}) is not None


def test_other_machines_need_the_token(shared: bik.Viewer) -> None:
    refused = "this viewer needs the token: open the whole address that viewer.url has\n"
    wrong = token(shared)[:-1] + ("A" if token(shared)[-1] != "A" else "B")
    for path in ("/", "/?token=", f"/?token={wrong}", "/?token=%ff", f"/?tokens={token(shared)}"):
        status, headers, content = page(shared, path)
        assert (status, content.decode()) == (403, refused)
        assert "Set-Cookie" not in headers
    assert websocket_status(shared) == 403
    assert websocket_status(shared, Cookie=f"beetle_ik_token={wrong}") == 403


@pytest.mark.parametrize("before", ["", "; connect-src *@"])
def test_a_page_loads_nothing_from_other_sites(viewer: bik.Viewer, before: str) -> None:
    _, headers, _ = page(viewer, "/?playbackPath=https://evil.example/x.viser", Host=before + place(viewer))
    directives = headers["Content-Security-Policy"].split("; ")
    here = place(viewer)
    assert [each for each in directives if each.startswith("connect-src")] == [
        f"connect-src 'self' ws://{here} wss://{here} data: blob:"
    ]


def test_the_token_lasts_for_the_websocket(shared: bik.Viewer) -> None:
    status, headers, _ = page(shared, f"/?token={token(shared)}")
    assert status == 200
    assert headers["Set-Cookie"] == f"beetle_ik_token={token(shared)}; Path=/; HttpOnly; SameSite=Strict"
    assert headers["Referrer-Policy"] == "no-referrer"
    cookie = headers["Set-Cookie"].partition(";")[0]
    assert websocket_status(shared, Cookie=cookie) == 101
    assert websocket_status(shared, Cookie=cookie, Origin="http://evil.example") == 403
    assert page(shared, Cookie=cookie, Host="evil.example")[0] == 421
    assert page(shared, Cookie=cookie, Host="192.0.2.7:8080")[0] == 200


def test_a_viewer_prints_its_address_alone(capsys: pytest.CaptureFixture[str]) -> None:
    with bik.view(bik.Robot.named("ur5e"), port=0) as viewer:
        address = viewer.url
    out, err = capsys.readouterr()
    assert (out, err) == (f"Viewer: {address}\n", "")


def test_tokens_differ_and_only_other_machines_need_them() -> None:
    assert len({Admission("0.0.0.0").token for _ in range(20)}) == 20
    assert all(Admission(host).token is None for host in ("127.0.0.1", "127.0.0.9", "localhost", "::1"))
    for host in ("0.0.0.0", "::", "192.0.2.7", "robot.example"):
        token = Admission(host).token
        assert token is not None
        assert len(token) >= 32


def test_other_servers_of_viser_are_left_alone() -> None:
    viewer = bik.view(ROBOT, port=0)
    viewer.close()
    other = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        connection = http.client.HTTPConnection("127.0.0.1", other.get_port())
        connection.putrequest("GET", "/", skip_host=True)
        connection.putheader("Host", "other.example")
        connection.endheaders()
        assert connection.getresponse().status == 200
        connection.close()
    finally:
        other.stop()


def test_a_viser_that_serves_in_another_way_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    unhooked = viser.infra._infra.websockets

    class Server(viser.ViserServer):
        def __init__(self, **options: Any) -> None:
            viser.infra._infra.websockets = unhooked
            super().__init__(**options)

    monkeypatch.setattr(viser, "ViserServer", Server)
    with pytest.raises(bik.BeetleIkError, match="does not serve at port"):
        bik.view(ROBOT, port=0)


# --- what it may send ---


def controls(viewer: bik.Viewer) -> list[Any]:
    return list(viewer.server.gui._gui_input_handle_from_uuid.values())


def malformed(viewer: bik.Viewer) -> list[bytes | str]:
    nan, far = float("nan"), 1e300
    drags = [
        *({"position": each} for each in ((nan, 0, 0), (0, 0), (0, 0, 0, 0), "abc", None, (far, 0, 0), ("1", 0, 0))),
        *({"wxyz": wxyz} for wxyz in ((0, 0, 0, 0), (nan, 0, 0, 1), (1, 0, 0), 1)),
        *({"name": 3}, {"owner": None}, {"unknown": 1}, {"type": ["a"]}, {"type": "Message"}, {"type": 1}),
    ]  # fmt: skip
    values = [nan, far, -(2**63), 2**63, "x" * 200_000, "other", None, [], [1, 2], [nan] * 3, {"a": 1}, b"bytes", -9e5]
    updates = [{"value": value} for value in values] + [{"removed": True}, {"update_cb": []}, {}, 3, None]
    changed = [
        encoded(type="GuiUpdateMessage", uuid=control._impl.uuid, updates=update)
        for control in controls(viewer)
        for update in updates
        if not (isinstance(control.value, str) and update == {"value": "other"} and not hasattr(control, "options"))
    ]
    shares = [encoded(type=name) for name in ("ShareUrlRequest", "ShareUrlDisconnect", "SceneNodeUpdateMessage")]
    junk = [b"", b"\xc1", b"\x91" * 100_000, dragged(0.1)[:-3], encoded(), b"\x07", "text", dragged(0.1).hex()]
    return [*(dragged(0.1, **drag) for drag in drags), *changed, *shares, *junk]


def test_malformed_messages_change_nothing(viewer: bik.Viewer) -> None:
    viewer.target = (0.7, 0.2, 0.0)
    arrives(viewer, 0.7)
    before = viewer.follow, len(viewer.obstacles)
    values = [control.value for control in controls(viewer)]
    with joined(viewer) as connection:
        for message in malformed(viewer):
            connection.send(message)
        connection.send(dragged(0.6))
        arrives(viewer, 0.6)
    np.testing.assert_array_equal(viewer.target[:3, :3], np.eye(3))
    assert (viewer.follow, len(viewer.obstacles)) == before
    texts = [control.value for control in controls(viewer) if isinstance(control.value, str | bool)]
    assert texts == [value for value in values if isinstance(value, str | bool)]


def test_a_thousand_bad_messages_leave_the_viewer_working(viewer: bik.Viewer, caplog: pytest.LogCaptureFixture) -> None:
    random = np.random.default_rng(0)
    good = dragged(0.55)
    with joined(viewer) as connection:
        for i in range(1000):
            torn = bytearray(good)
            for place in random.integers(len(torn), size=1 + i % 4):
                torn[place] = random.choice([0, 0x7F, 0x80, 0x90, 0xC0, 0xC1, 0xCB, 0xFF])
            connection.send(bytes(torn) if i % 2 else bytes(torn[: random.integers(len(torn))]))
        connection.send(dragged(0.5))
        arrives(viewer, 0.5)
    assert np.isfinite(viewer.target).all()
    told = [record for record in caplog.records if "malformed" in record.message]
    assert len(told) == 1


def test_a_huge_message_ends_its_own_connection_alone(viewer: bik.Viewer) -> None:
    with joined(viewer) as connection:
        connection.send(bytes(17 * 2**20))
        with pytest.raises(ConnectionClosed):
            all(connection)  # all that it receives
    with joined(viewer) as connection:
        connection.send(dragged(0.45))
        arrives(viewer, 0.45)


def test_good_values_of_controls_are_taken(viewer: bik.Viewer) -> None:
    slider = next(control for control in controls(viewer) if control.label == ROBOT.joint_names[0])
    with joined(viewer) as connection:
        connection.send(CAMERA)  # from then on the page is a client
        for value in (1, 0.5, slider.max + 1):  # a page sends whole numbers as integers
            connection.send(encoded(type="GuiUpdateMessage", uuid=slider._impl.uuid, updates={"value": value}))
        until(lambda: viewer.q[0] == 0.5)
    assert viewer.q[0] == slider.value == 0.5
