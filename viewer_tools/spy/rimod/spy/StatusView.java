package rimod.spy;

import java.awt.BorderLayout;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;
import javax.swing.JLabel;
import javax.swing.JScrollPane;
import javax.swing.JSplitPane;
import javax.swing.JTable;
import javax.swing.table.DefaultTableModel;
import rimod.status_t;

/** Tables of what the processes tell: counts, and the times of their stages. */
final class StatusView extends ChannelView {
  private static final long serialVersionUID = 1;
  private static final int MAX_PROCESSES = 64;

  private static final class Status {
    String process, host, version, lastError;
    int pid;
    long in, out, dropped, rejected;
    long arrival; // ns
    final Map<String, Double> stages = new TreeMap<>();
    String key() {
      return process + " " + host + " " + pid;
    }
  }

  private final String channel;
  private final transient Map<String, Status> statuses = new TreeMap<>();
  private final JLabel title = new JLabel(" ");
  private final DefaultTableModel processes = table(
      "process", "host", "pid", "in", "out", "dropped", "rejected", "silent [s]", "last error");
  private final DefaultTableModel stages = table("process", "stage", "time [ms]");

  StatusView(String channel) {
    super(860, 480);
    this.channel = channel;
    JTable upper = new JTable(processes);
    upper.getColumnModel().getColumn(0).setPreferredWidth(130); // names are long
    JSplitPane tables = new JSplitPane(
        JSplitPane.VERTICAL_SPLIT, new JScrollPane(upper), new JScrollPane(new JTable(stages)));
    tables.setDividerLocation(150);
    add(title, BorderLayout.NORTH);
    add(tables, BorderLayout.CENTER);
  }

  private static DefaultTableModel table(String... columns) {
    return new DefaultTableModel(columns, 0) {
      private static final long serialVersionUID = 1;

      @Override
      public boolean isCellEditable(int row, int column) {
        return false;
      }
    };
  }

  @Override
  List<String> channels() {
    return List.of(channel);
  }

  @Override
  void take(String from, byte[] bytes) throws BadMessage {
    Status status = read(bytes);
    if (statuses.size() >= MAX_PROCESSES && !statuses.containsKey(status.key()))
      throw new BadMessage("is of one process too many");
    statuses.put(status.key(), status);
  }

  synchronized int numProcesses() {
    return statuses.size();
  }

  private static Status read(byte[] bytes) throws BadMessage {
    MessageReader reader = new MessageReader(bytes, status_t.LCM_FINGERPRINT);
    Status status = new Status();
    reader.readLong(); // wall clock there
    status.process = reader.readString();
    status.version = reader.readString();
    status.pid = reader.readInt();
    status.host = reader.readString();
    status.in = reader.readLong();
    status.out = reader.readLong();
    status.dropped = reader.readLong();
    status.rejected = reader.readLong();
    int numCounters = reader.readCount(4 + 1 + 8);
    for (int i = 0; i < numCounters; ++i) {
      reader.readString();
      reader.readLong();
    }
    int numStages = reader.readCount(4 + 1 + 8);
    for (int i = 0; i < numStages; ++i) status.stages.put(reader.readString(), reader.readDouble());
    status.lastError = reader.readString();
    status.arrival = System.nanoTime();
    return status;
  }

  @Override
  synchronized boolean refresh() {
    boolean changed = super.refresh();
    if (changed) fill();
    tellSilence();
    return changed;
  }

  private void fill() {
    title.setText(" " + statuses.size() + " processes on " + channel + complaint());
    processes.setRowCount(0);
    stages.setRowCount(0);
    for (Status s : statuses.values()) {
      processes.addRow(new Object[] {
          s.process, s.host, s.pid, s.in, s.out, s.dropped, s.rejected, "", s.lastError});
      for (Map.Entry<String, Double> stage : s.stages.entrySet())
        stages.addRow(
            new Object[] {s.process, stage.getKey(), String.format("%.1f", stage.getValue())});
    }
  }

  private void tellSilence() {
    long now = System.nanoTime();
    int row = 0;
    for (Status s : statuses.values()) {
      String silence = Long.toString((now - s.arrival) / 1_000_000_000L);
      if (!silence.equals(processes.getValueAt(row, 7))) processes.setValueAt(silence, row, 7);
      ++row;
    }
  }
}
