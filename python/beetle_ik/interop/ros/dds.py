"""Topics, types and qualities of service of ROS 2 in DDS, by cyclonedds."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from cyclonedds.core import InstanceState, Policy, Qos, ReadCondition, SampleState, ViewState, WaitSet
from cyclonedds.domain import DomainParticipant
from cyclonedds.internal import InvalidSample
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

_BLOCKED = duration(milliseconds=100)


def quality(*, reliable: bool = True, latched: bool = False, depth: int = 10) -> Qos:
    """Returns a quality of service; the defaults are those of ROS 2, and `latched` is its transient local."""
    return Qos(
        Policy.Reliability.Reliable(_BLOCKED) if reliable else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile,
        Policy.History.KeepLast(depth),
        Policy.DataRepresentation(use_cdrv0_representation=True),
    )


def mangled(topic: str) -> str:
    """Returns the name of a ROS topic in DDS: "/joint_states" and "joint_states" are "rt/joint_states"."""
    return "rt/" + topic.lstrip("/")


@dataclass(frozen=True)
class _Subscription:
    topic: str
    reader: DataReader
    handle: Callable[[Any], None]


class Graph:
    """One participant with its publishers and subscriptions, all served by the thread that calls `wait`.

    Args:
        domain: number of the domain, ROS_DOMAIN_ID.
        say: logs a level and a text.
    """

    def __init__(self, domain: int, say: Callable[[str, str], None]) -> None:
        """Joins the domain."""
        self.participant, self.say = DomainParticipant(domain), say
        self.waiting = WaitSet(self.participant)
        self.subscriptions: list[_Subscription] = []

    def publisher(self, topic: str, kind: type, quality: Qos) -> DataWriter:
        """Makes a publisher."""
        return DataWriter(self.participant, Topic(self.participant, mangled(topic), kind, qos=quality), qos=quality)

    def subscribe(self, topic: str, kind: type, quality: Qos, handle: Callable[[Any], None]) -> None:
        """Subscribes `handle` to a topic."""
        reader = DataReader(self.participant, Topic(self.participant, mangled(topic), kind, qos=quality), qos=quality)
        self.waiting.attach(ReadCondition(reader, SampleState.Any | ViewState.Any | InstanceState.Any))
        self.subscriptions.append(_Subscription(topic, reader, handle))

    def wait(self, seconds: float) -> None:
        """Waits for messages, at most this long, and handles those that have come."""
        if not self.waiting.wait(duration(nanoseconds=max(int(seconds * 1e9), 1))):
            return
        for each in self.subscriptions:
            try:
                samples = each.reader.take(N=100)
            except Exception as broken:  # cyclonedds lets through whatever its decoder meets
                self.say("error", f"{each.topic}: a message that cannot be decoded: {broken!r:.200}")
                continue
            for sample in samples:
                if not isinstance(sample, InvalidSample):
                    each.handle(sample)
