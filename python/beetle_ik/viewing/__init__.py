"""Interactive view of a robot in the browser: `beetle_ik.view`, on viser.

    opening     the call `view`
    viewer      the public class: joins the parts below, and answers Python
    checks      checks of its arguments
    turns       changes of the state by its thread and by Python, one at a time
    worker      the only thread that moves the arm
    address     a free port
    admission   access to the page
    incoming    checks of the messages that it sends
    served      the server of viser, with both
    arm         the state of the arm, without a page: configuration, target, obstacles, mode of following the target
    start       bodies, speeds and a configuration for robots whose models lack them
    parts       the parts of the page together
    page        data shared by the parts
    looks       appearance of the links: visual meshes, or solids along the joints
    camera      the first view
    loads       torques of the motors as shares of their limits
    surfaces    the links in the scene, and their ghosts
    handle, joints, obstacles, postures, playback, planning, reach, report
                the parts of the page: each shows and changes one thing of the state
    files       files that visitors save and load: programs, scenes
    program     the state as a program in Python
    displaced, sizes
                obstacles, moved and resized
    recording   the scene and its motion as a file that plays by itself

viser calls back in the thread of its server. A part of the page never moves the arm there: it asks the worker.
"""

from .opening import view
from .recording import write_player
from .viewer import Viewer

__all__ = ["Viewer", "view", "write_player"]
