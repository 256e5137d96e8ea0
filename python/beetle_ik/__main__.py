"""`python -m beetle_ik`: the same as the command `beetle-ik`."""

from .cli import main

main()
