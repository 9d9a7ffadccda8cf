"""Modules of the commands in scripts and experiments. They are installed beside the commands, where Python finds
them without any setup; the devel space has a link."""
