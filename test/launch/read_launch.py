#!/usr/bin/env python3
"""Prints what a launch file would start and set, as JSON, without a master: read_launch.py FILE [NAME:=VALUE]...

The keys are NODE (package/type args), NODE TOPIC (the topic it is remapped to), PARAMETER, cleared,
respawned (nodes), and warnings (their number).
"""

import json
import sys

from roslaunch.config import load_config_default

config = load_config_default([(sys.argv[1], sys.argv[2:])], None, assign_machines=False)
found = {name: json.dumps(param.value) if isinstance(param.value, list) else param.value
         for name, param in config.params.items()}
for node in config.nodes:
    name = node.namespace + node.name
    found[name] = f'{node.package}/{node.type} {node.args}'
    for topic, target in node.remap_args:
        found[f'{name} {topic}'] = target
found['respawned'] = ' '.join(node.namespace + node.name for node in config.nodes if node.respawn)
found['cleared'] = ' '.join(config.clear_params)
found['warnings'] = len(config.config_errors)
json.dump(found, sys.stdout, default=str)
