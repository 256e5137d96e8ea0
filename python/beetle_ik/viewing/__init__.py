"""A robot in the browser, to look at and to steer: `beetle_ik.view`, on viser.

    viewer      the public class: joins the parts below, and answers Python
    checks      its arguments
    turns       how its thread and Python change the state, one at a time
    worker      the only thread that moves the arm
    address     a free port
    admission   who may use the page
    incoming    which messages it may send
    served      the server of viser, with both
    arm         the state of the arm: configuration, target, obstacles, how it follows the target. Without a page
    start       bodies, speeds and a configuration for robots that come without
    parts       what the page consists of
    page        what its parts share
    looks       what is seen of the links: visual meshes, or solids along the joints
    camera      from where it is seen first
    surfaces    the links in the scene, and ghosts of them
    handle, joints, obstacles, postures, playback, planning, reach, report
                the parts of the page: each shows and changes one thing of the state
    files       what visitors take along and bring: programs, scenes
    program     the state as a program in Python
    displaced, sizes
                obstacles, moved and made larger
    recording   what the page shows, as a file that plays by itself

viser calls back in the thread of its server. A part of the page never moves the arm there: it asks the worker.
"""

from .recording import write_player
from .viewer import Viewer, view

__all__ = ["Viewer", "view", "write_player"]
