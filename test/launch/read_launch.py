#!/usr/bin/env python3
"""Prints what a launch file would start and set, as JSON, without a master: read_launch.py FILE [NAME:=VALUE]..."""

import json
import sys

from roslaunch.config import load_config_default

config = load_config_default([(sys.argv[1], sys.argv[2:])], None, assign_machines=False)
nodes = {
    node.namespace + node.name: {
        "type": node.package + "/" + node.type,
        "args": node.args,
        "required": node.required,
        "remappings": {old: new for old, new in node.remap_args},
    }
    for node in config.nodes
}
params = {name: param.value for name, param in config.params.items()}
json.dump({"nodes": nodes, "params": params, "cleared": config.clear_params}, sys.stdout, default=str)
