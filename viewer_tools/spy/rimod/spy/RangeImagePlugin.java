package rimod.spy;

import lcm.spy.SpyPlugin;
import rimod.range_image_t;

/** A double click on a channel of rimod.range_image_t shows the range image with its interest points. */
public final class RangeImagePlugin extends ViewPlugin implements SpyPlugin {
  public RangeImagePlugin() {
    super(range_image_t.LCM_FINGERPRINT, "range image", RangeImageView::new);
  }
}
