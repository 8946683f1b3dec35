"""Tables of a machine file that another room describes: that is imported when a file has the table."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Annotated, Any

from pydantic import BaseModel, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, SchemaValidator, core_schema


@dataclass(frozen=True)
class DeferredModel:
    """Mark of an entry that a model in another room describes."""

    module: str  # name of the module below the package
    name: str  # name of the model in it
    is_file: bool = False  # whether a machine file names a file that describes it, in its place

    def model(self) -> type[BaseModel]:
        """The model, imported now."""
        model: type[BaseModel] = getattr(import_module(f"linkwright.{self.module}"), self.name)
        return model

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """A schema that asks the model when there is something to check."""
        return core_schema.with_info_plain_validator_function(self._checked)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """That of the model, once for all places that it has; a text where a file is named."""
        if self.is_file:
            return {"type": "string"}
        model = self.model()
        model.model_rebuild()
        core: Any = dict(model.__pydantic_core_schema__)
        inner = core["schema"] if core["type"] == "definitions" else core
        named = {**inner, "ref": f"{self.module}.{self.name}"}
        return handler({**core, "schema": named} if inner is not core else named)

    def _checked(self, value: Any, info: core_schema.ValidationInfo) -> BaseModel:
        model = self.model()
        if not isinstance(model.__pydantic_validator__, SchemaValidator):
            model.model_rebuild()
        checked: BaseModel = model.__pydantic_validator__.validate_python(value, context=info.context)
        return checked


def deferred_model(module: str, name: str) -> Any:
    """The type of an entry that the model ``name`` of a module below the package describes."""
    return Annotated[Any, DeferredModel(module, name)]
