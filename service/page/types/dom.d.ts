/** What the elements of lib/dom.js are made of. */

declare namespace Dom {
  /** What may stand in an element; null, undefined and false are left out, lists are laid flat. */
  type Child = Node | string | null | undefined | false | readonly Child[];
  type Value = string | number | boolean | null | undefined;
  /** A listener, whose event knows the element that listens. */
  type Listeners<Of extends Element> = {
    [Name in keyof HTMLElementEventMap as `on${Name}`]?: (event: HTMLElementEventMap[Name] & { currentTarget: Of }) => unknown;
  };
  type Named =
    | "accept" | "alt" | "autocomplete" | "autofocus" | "checked" | "class" | "colspan" | "cx" | "cy" | "d" | "datetime" | "disabled" | "download" | "draggable"
    | "for" | "height" | "hidden" | "href" | "id" | "inputmode" | "max" | "maxlength" | "method" | "min" | "name" | "novalidate" | "open" | "placeholder"
    | "r" | "required" | "reversed" | "role" | "rows" | "rx" | "scope" | "selected" | "spellcheck" | "src" | "step" | "tabindex" | "text-anchor"
    | "title" | "transform" | "type" | "value" | "viewBox" | "width" | "x" | "x1" | "x2" | "y" | "y1" | "y2";
  type Attributes<Of extends Element = Element> = Listeners<Of> & { [Name in Named]?: Value } & { [name: `data-${string}` | `aria-${string}`]: Value };
}
