"""The console script `whit`: the program that the package brings along."""
import os
import sys


def main() -> None:
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "whit")
    os.execv(program, ["whit", *sys.argv[1:]])
