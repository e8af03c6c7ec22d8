"""The buttons of the panel."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from . import grooming, identity, installation, schema, shots
from .edited_text import stem_of
from .names import distinct, file_name, folded
from .properties import Document
from .refused import Refused
from .session import Request, clean_environment, session

# Recipes that come with Ringlet, by name: group and text.
LOOKS = json.loads(Path(__file__).with_name("looks.json").read_text(encoding="utf-8"))
LOOK_ITEMS = [(name, name.replace("_", " "), f"{one['group']}: {name}") for name, one in LOOKS.items()]
OPERATOR_ITEMS = [(name, name.replace("_", " "), text[:200]) for name, (text, _) in schema.operators().items()]
CHANGES = [(name, name, "") for name in ("remove", "up", "down")]


class OnHead:
    """An operator on the mesh that is active."""

    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return (head := head_of(context)) is not None and head.ringlet.recipe is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        head = head_of(context)
        try:
            identity.refuse_linked(head)
            identity.settle()
            self.act(context, head)
        except Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def head_of(context: bpy.types.Context) -> bpy.types.Object | None:
    """The active mesh, or the head of the active curves."""
    thing = context.active_object
    if thing is not None and thing.type == "CURVES" and thing.parent is not None:
        thing = thing.parent
    return thing if thing is not None and thing.type == "MESH" else None


class Begin(OnHead, bpy.types.Operator):
    """Grow hair on the active mesh with a recipe that comes with Ringlet"""

    bl_idname = "ringlet.begin"
    bl_label = "Grow Hair"

    look: EnumProperty(name="Look", items=LOOK_ITEMS)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return head_of(context) is not None

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        grooming.begin(head, LOOKS[self.look]["text"], f"{head.name} {self.look}")


class OpenRecipe(OnHead, bpy.types.Operator):
    """Grow hair on the active mesh with a recipe from a file"""

    bl_idname = "ringlet.open_recipe"
    bl_label = "Open Recipe"

    filepath: StringProperty(subtype="FILE_PATH")
    filter_glob: StringProperty(default="*.toml", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return head_of(context) is not None

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        path = Path(bpy.path.abspath(self.filepath))
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise Refused(f"{path}: cannot be read ({error}); choose a recipe") from None
        grooming.begin(head, text, stem_of(path.name))


class NewVariant(OnHead, bpy.types.Operator):
    """Go on with a copy of the recipe; the one before stays in the .blend"""

    bl_idname = "ringlet.new_variant"
    bl_label = "New Variant"

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        own = head.ringlet
        name = f"{stem_of(own.recipe.name)} variant"
        variant = identity.new_text(name, "recipe", head, own.recipe.as_string())
        variant.ringlet_changes = own.recipe.ringlet_changes
        own.recipe = variant


class AddOperator(OnHead, bpy.types.Operator):
    """Add an operator on the shape of the locks"""

    bl_idname = "ringlet.add_operator"
    bl_label = "Add Operator"

    op: EnumProperty(name="Operator", items=OPERATOR_ITEMS)

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        Document(head, "recipe").change(add="shape", at=len(head.ringlet.shape), entry={"op": self.op})


class ChangeOperator(OnHead, bpy.types.Operator):
    """Remove an operator, or move it up or down"""

    bl_idname = "ringlet.change_operator"
    bl_label = "Change Operator"

    row: IntProperty()
    what: EnumProperty(items=CHANGES)

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        document, to = Document(head, "recipe"), self.row + {"up": -1, "down": 1, "remove": 0}[self.what]
        if self.what == "remove":
            document.change(remove="shape", at=self.row)
        elif 0 <= to < len(head.ringlet.shape):
            document.change(move="shape", at=self.row, to=to)


class SculptGuides(OnHead, bpy.types.Operator):
    """Copy the guides and sculpt the copy: from then on it gives silhouette and length"""

    bl_idname = "ringlet.sculpt_guides"
    bl_label = "Sculpt Guides"

    def act(self, context: bpy.types.Context, head: bpy.types.Object) -> None:
        source = head.ringlet.guide_curves
        if source is None:
            raise Refused("There are no guides yet; wait for the groom")
        thing = bpy.data.objects.new(f"{head.name} sculpted guides", source.data.copy())
        identity.link_with(head, thing)
        thing.parent, thing.matrix_parent_inverse = head, source.matrix_parent_inverse
        head.ringlet.guides = thing
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for one in context.selected_objects:
            one.select_set(False)
        thing.select_set(True)
        context.view_layer.objects.active = thing
        bpy.ops.object.mode_set(mode="SCULPT_CURVES")


class AddImage(OnHead, bpy.types.Operator):
    """Add an image as a map over the texture coordinates of the head"""

    bl_idname = "ringlet.add_image"
    bl_label = "Add Image"

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        head.ringlet.images.add()


class RemoveImage(OnHead, bpy.types.Operator):
    """Take an image out"""

    bl_idname = "ringlet.remove_image"
    bl_label = "Remove Image"

    row: IntProperty()

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        head.ringlet.images.remove(self.row)


class Simulate(OnHead, bpy.types.Operator):
    """Simulate the frames of the scene"""

    bl_idname = "ringlet.simulate"
    bl_label = "Simulate"
    bl_options: ClassVar = set()

    resume: bpy.props.BoolProperty(description="Go on with the run that was canceled or killed")

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        shots.start(head, resume=self.resume)


class Cancel(bpy.types.Operator):
    """Cancel the simulation; frames that are done are kept"""

    bl_idname = "ringlet.cancel"
    bl_label = "Cancel"

    def execute(self, _context: bpy.types.Context) -> set[str]:
        shots.cancel()
        return {"FINISHED"}


class Bake(OnHead, bpy.types.Operator):
    """Write the hairs of the simulated shot to a USD file, and play them"""

    bl_idname = "ringlet.bake"
    bl_label = "Bake Hairs"
    bl_options: ClassVar = set()

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        shots.bake(head)


class ClearMotion(OnHead, bpy.types.Operator):
    """Show the groom again in place of the simulation"""

    bl_idname = "ringlet.clear_motion"
    bl_label = "Show Groom"

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        for name in ("hair_motion", "lock_motion"):
            shots.clear(head, name)
        shots.clear_cloth(head)


class Export(OnHead, bpy.types.Operator):
    """Write the groom as USD, with the other recipes of this .blend for the same head as variants"""

    bl_idname = "ringlet.export"
    bl_label = "Write USD"
    bl_options: ClassVar = set()

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        recipe, own = grooming.recipe_message(head), head.ringlet
        others = [text for text in bpy.data.texts if text.ringlet_head == own.id and text != own.recipe]
        stems = distinct([stem_of(text.name) for text in others], file_name, folded)
        variants = [
            {**grooming.recipe_message(head, text), "name": f"{stem}.recipe.toml"}
            for text, stem in zip(others, stems, strict=True)
        ]
        state, folder = grooming.state_of(head), grooming.folder_of(head)

        def done(message) -> None:
            state.message = f"Wrote {message.header['path']}"

        def failed(line: str) -> None:
            state.message = line

        grooming.send_files(head)
        request = Request(done, failed)
        session.send("write_groom", request, folder=str(folder), recipe=recipe, file="groom.usdc", variants=variants)


class View(OnHead, bpy.types.Operator):
    """Open the recipe in Ringlet's review page, in the browser"""

    bl_idname = "ringlet.view"
    bl_label = "Open Review"
    bl_options: ClassVar = set()

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        command, recipe = installation.command(), grooming.folder_of(head) / grooming.recipe_file(head.ringlet.recipe)
        if command is None:
            raise Refused("Ringlet is not installed; see the extension's preferences")
        if not recipe.is_file():
            raise Refused("The groom is not made yet; wait for it")
        subprocess.Popen([*command, "view", str(recipe)], env=clean_environment(), stdin=subprocess.DEVNULL)


class TakeSaved(OnHead, bpy.types.Operator):
    """Take the recipe as the review page saved it"""

    bl_idname = "ringlet.take_saved"
    bl_label = "Take from Review"

    def act(self, _context: bpy.types.Context, head: bpy.types.Object) -> None:
        recipe = grooming.folder_of(head) / grooming.recipe_file(head.ringlet.recipe)
        if not recipe.is_file():
            raise Refused(f"{recipe}: there is no such file; open the review first")
        head.ringlet.recipe.from_string(recipe.read_text(encoding="utf-8"))
        head.ringlet.recipe.ringlet_changes = ""


class Restart(bpy.types.Operator):
    """End Ringlet's process and start another"""

    bl_idname = "ringlet.restart"
    bl_label = "Restart Ringlet"

    def execute(self, _context: bpy.types.Context) -> set[str]:
        session.stop()
        session.retry()
        grooming.forget()
        return {"FINISHED"}


class Install(bpy.types.Operator):
    """Install Ringlet into an environment of its own"""

    bl_idname = "ringlet.install"
    bl_label = "Install Ringlet"

    def execute(self, _context: bpy.types.Context) -> set[str]:
        try:
            installation.installation.start(installation.preference("wheel") or "ringlet")
        except Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (
    Begin,
    OpenRecipe,
    NewVariant,
    AddOperator,
    ChangeOperator,
    SculptGuides,
    AddImage,
    RemoveImage,
    Simulate,
    Cancel,
    Bake,
    ClearMotion,
    Export,
    View,
    TakeSaved,
    Restart,
    Install,
)


def register() -> None:
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister() -> None:
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
