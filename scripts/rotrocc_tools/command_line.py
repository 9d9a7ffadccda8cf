"""Command lines of the scripts, whose --help is like that of the programs."""
import argparse
import pathlib
import sys


class Parser(argparse.ArgumentParser):
    """Its help begins with the first sentence of `text`, which says what the script is for, and an
    `example`. The rest of `text` follows the usage."""

    def __init__(self, text, example):
        self.purpose, _, details = text.strip().partition('\n\n')
        self.example = example
        super().__init__(description=details, formatter_class=argparse.RawDescriptionHelpFormatter)
        self._optionals.title = 'options'  # so in newer Python

    def format_help(self):
        usage, _, rest = super().format_help().partition('\n\n')
        return '%s\n\nexample: %s\n%s\n\n%s' % (
            self.purpose, self.example, usage.replace('usage: ', 'usage:   ', 1).replace('\n', '\n  '), rest)

    def error(self, message):
        self.exit(2, '%s: %s; --help shows the usage\n' % (self.prog, message))


def run(main):
    """Ends a script with the status of main(), or with the message of its error."""
    try:
        sys.exit(main())
    except (RuntimeError, OSError, ValueError, KeyError) as error:
        sys.exit('%s: %s' % (pathlib.Path(sys.argv[0]).name, error))
