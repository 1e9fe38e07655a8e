"""The add-on for Blender with a bpy of the test's own, which names sockets as Blender 3.4 or 4 does: what a Principled
shader gets in the place of simple shaders, and that all is as it was afterwards."""
import contextlib
import importlib.util
import sys
import types

NAMES = {
    3: ["Base Color", "Metallic", "Specular", "Roughness", "IOR", "Transmission", "Emission", "Emission Strength",
        "Alpha", "Normal"],
    4: ["Base Color", "Metallic", "Roughness", "IOR", "Alpha", "Normal", "Specular IOR Level", "Transmission Weight",
        "Coat Weight", "Sheen Weight", "Emission Color", "Emission Strength"],
}
BEFORE = {"Specular": .5, "Specular IOR Level": .5, "Alpha": 1}
SIMPLE = {
    "BSDF_DIFFUSE": ["Color", "Roughness", "Normal"],
    "BSDF_GLOSSY": ["Color", "Roughness", "Normal"],
    "BSDF_GLASS": ["Color", "Roughness", "IOR", "Normal"],
    "EMISSION": ["Color", "Strength"],
}


class Socket:
    def __init__(self, node, name, value):
        self.node, self.name, self.default_value, self.links = node, name, value, []

    @property
    def is_linked(self):
        return bool(self.links)


class Node:
    def __init__(self, kind, names):
        self.type = self.bl_label = kind
        self.inputs = {name: Socket(self, name, f"{kind}.{name}" if kind in SIMPLE else BEFORE.get(name, 0))
                       for name in names}
        self.outputs = [Socket(self, "out", None)]


class Tree:
    """A material's: a shader, and the output that it is linked to."""

    def __init__(self, version, shader):
        self.version, self.output = version, Node("OUTPUT", ["Surface", "Displacement"])
        self.nodes, self.links = self, self
        self.all = [shader]
        self.link(shader.outputs[0])

    def link(self, source, to=None):
        to = to or self.output.inputs["Surface"]
        to.links = [types.SimpleNamespace(from_node=source.node, from_socket=source, to_socket=to)]

    def new(self, what, to=None):
        if to:
            return self.link(what, to)
        self.all.append(Node("BSDF_PRINCIPLED", NAMES[self.version]))
        return self.all[-1]

    def remove(self, node):
        self.all.remove(node)

    def get_output_node(self, _engine):
        return self.output


def load(path, version):
    def anything(*_args, **_more):
        return None

    bpy = types.ModuleType("bpy")
    bpy.props = types.ModuleType("bpy.props")
    bpy.props.BoolProperty = bpy.props.IntProperty = bpy.props.StringProperty = anything
    bpy.types = types.SimpleNamespace(AddonPreferences=object, Operator=object, Panel=object)
    bpy.app = types.SimpleNamespace(version=(version, 4 if version == 3 else 0, 0))
    sys.modules.update({"bpy": bpy, "bpy.props": bpy.props})
    spec = importlib.util.spec_from_file_location("retex_export", path)
    addon = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(addon)
    return addon


def main():
    for version in (3, 4):
        addon = load(sys.argv[1], version)
        print("Blender", version)
        for kind, names in SIMPLE.items():
            shader = Node(kind, names)
            tree = Tree(version, shader)
            material = types.SimpleNamespace(name=kind, use_nodes=True, node_tree=tree, blend_method="OPAQUE")
            with contextlib.ExitStack() as stack:
                addon.prepare_material(stack, material, print)
                made = tree.output.inputs["Surface"].links[0].from_node
                print(" ", kind, {n: s.default_value for n, s in made.inputs.items() if s.default_value != BEFORE.get(n, 0)})
            back = tree.output.inputs["Surface"].links[0].from_node is shader and tree.all == [shader]
            if not back or material.blend_method != "OPAQUE":
                print("  not as it was")
        plain = [types.SimpleNamespace(name=n, retex_target=t, retex_target_name=m)
                 for n, t, m in (("b", 1, ""), ("a", 1, "b"), ("c", 0, ""), ("d", 1, ""))]
        print(" ", addon.ticked_targets(plain), addon.identifier("2nd floor.001"))


main()
